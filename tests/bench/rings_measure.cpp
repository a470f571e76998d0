// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rings_measure.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <ctime>

#include "ipc/base/clock.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/rings_process.hpp"

namespace handcast::bench {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000'000 / kRate_hz;

/// What the consumer tells its parent.
struct Record {
  std::atomic<bool> listening{false};
  std::size_t count = 0;
  std::array<double, kMessages> seen_us{}, consumed_us{};
  double cpu_percent = 0;
};

/// Zero-initialised memory that parent and children share.
class SharedRecord {
 public:
  SharedRecord()
      : record_(new (::mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0)) Record) {}
  ~SharedRecord() { ::munmap(record_, sizeof(Record)); }
  SharedRecord(const SharedRecord&) = delete;
  Record& operator*() const { return *record_; }
  Record* operator->() const { return record_; }

 private:
  Record* record_;
};

std::int64_t cpu_time_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

void consume(const Transport& transport, Record& record) {
  const auto take = transport.open_receiver();
  record.listening = true;
  std::int64_t first_ns = 0, first_cpu_ns = 0;
  volatile std::uint64_t read = 0;
  bool last = false;
  const auto look = [&](const Block& block) {
    const auto seen_ns = now_ns();
    read = sum(block);
    const auto consumed_ns = now_ns();
    if (record.count == kWarmUp) first_ns = seen_ns, first_cpu_ns = cpu_time_ns();
    record.seen_us[record.count] = ns_to_us(seen_ns - block.header.published_ns);
    record.consumed_us[record.count] = ns_to_us(consumed_ns - block.header.origin_ns);
    last = ++record.count == kMessages || block.header.frame_id >= kMessages;
  };
  while (!last && take(look)) continue;
  record.cpu_percent = 100.0 * static_cast<double>(cpu_time_ns() - first_cpu_ns) /
                       static_cast<double>(now_ns() - first_ns);
}

void produce(const Transport& transport, const Record& record) {
  for (const auto limit = Deadline::in(std::chrono::seconds(5)); !record.listening; ::usleep(200))
    if (limit.passed()) give_up("the consumer does not listen");
  const auto send = transport.open_sender();
  const auto start_ns = now_ns() + ms_to_ns(5);
  for (std::int64_t number = 1; number <= kMessages; ++number) {
    const auto due_ns = start_ns + number * kPeriod_ns;
    sleep_until_ns(due_ns - 100'000);  // a sleeper wakes up to this late
    while (now_ns() < due_ns) continue;
    send(static_cast<std::uint64_t>(number));
  }
}

}  // namespace

void measure(Row& row) {
  const auto transport = row.make();
  SharedRecord record;
  Process consumer(1, [&] { consume(transport, *record); });
  Process producer(0, [&] { produce(transport, *record); });
  consumer.join();
  producer.join();
  if (record->count <= kWarmUp) give_up(row.name + " carried nothing");
  const auto counted = [&](const auto& samples) {
    return std::vector<double>(&samples[kWarmUp], &samples[record->count]);
  };
  row.seen_p50_us.push_back(median(counted(record->seen_us)));
  row.seen_p99_us.push_back(percentile(counted(record->seen_us), 0.99));
  row.consumed_p50_us.push_back(median(counted(record->consumed_us)));
  row.consumed_p99_us.push_back(percentile(counted(record->consumed_us), 0.99));
  row.cpu_percent.push_back(record->cpu_percent);
  row.lost += kMessages - static_cast<int>(record->count);
}

}  // namespace handcast::bench
