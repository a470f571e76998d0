// What a ring costs between two processes, beside a Unix socket in the same run.
//   bench_rings [--goals FILE] [Google Benchmark's options]
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"

namespace handcast {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kPeriod_ns = 1'000'000'000 / 525;  // the paper's camera
constexpr int kRounds = 3;
constexpr int kMessages = 300;  // per round and transport
constexpr int kWarmUp = 30;     // of them, not counted
constexpr std::size_t kPoses_bytes = 2048;
constexpr std::size_t kFrame_bytes = 388'800;  // 720 x 540

/// `total_bytes` long, itself included.
struct Block {
  static constexpr std::string_view layout = "Block/1";
  msg::Header header;
  std::uint64_t total_bytes = sizeof(Block);
  std::uint64_t* words() { return reinterpret_cast<std::uint64_t*>(this + 1); }
  const std::uint64_t* words() const { return reinterpret_cast<const std::uint64_t*>(this + 1); }
  std::size_t used_bytes() const { return total_bytes; }
};

/// What a consumer process tells its parent.
struct Record {
  std::atomic<int> ready{0};
  int count = 0;
  std::array<std::int64_t, kMessages> seen_ns{};      ///< from the producer's last instruction before sending to the message in hand
  std::array<std::int64_t, kMessages> consumed_ns{};  ///< to every byte of it read
  double cpu_share = 0;
};

/// One way to carry blocks: `produce` sends one (called with its number), `consume` hands each one to its argument until the last.
struct Transport {
  std::function<void(std::uint64_t)> produce;
  std::function<void(const std::function<bool(const Block&)>&)> consume;
};

void fill(Block& block, std::uint64_t number, std::size_t bytes) {
  block.header.frame_id = number;
  block.total_bytes = bytes;
  std::fill_n(block.words(), (bytes - sizeof(Block)) / 8, number);
}

std::uint64_t sum(const Block& block) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < (block.total_bytes - sizeof(Block)) / 8; ++i) total += block.words()[i];
  return total;
}

template <class T>
T must(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "{}\n", result.error().what);
  std::exit(1);
}

ipc::Segment again(const ipc::Segment& segment) { return must(ipc::Segment::open(UniqueFd(::dup(segment.fd())))); }

Transport over_ring(std::size_t bytes, ipc::Wait wait) {
  const auto segment = std::make_shared<ipc::Segment>(must(ipc::Segment::create(ipc::RingSpec::of<Block>("bench", 4, false, bytes))));
  auto writer = std::make_shared<std::optional<ipc::Writer<Block>>>();
  const auto produce = [=](std::uint64_t number) {
    if (!*writer) writer->emplace(must(ipc::Writer<Block>::attach(again(*segment))));
    auto loan = (*writer)->loan();
    fill(*loan, number, bytes);
    loan->header.origin_ns = now_ns();
    (*writer)->publish(std::move(loan));
  };
  const auto consume = [=](const std::function<bool(const Block&)>& take) {
    auto reader = must(ipc::Reader<Block>::attach(again(*segment), wait));
    for (auto block = reader.next(Deadline::in(2s)); block && take(**block);) block = reader.next(Deadline::in(2s));
  };
  return {produce, consume};
}

/// SOCK_SEQPACKET keeps messages whole; a stream where the kernel allows no packet of that size.
std::array<int, 2> socket_pair_for(std::size_t bytes) {
  std::array<int, 2> ends{};
  const int room = static_cast<int>(bytes * 4);
  const std::vector<std::byte> probe(bytes);
  for (const int type : {SOCK_SEQPACKET, SOCK_STREAM}) {
    if (::socketpair(AF_UNIX, type, 0, ends.data()) != 0) std::exit(1);
    if (::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUFFORCE, &room, sizeof room) != 0)
      ::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
    if (type == SOCK_STREAM) break;
    std::vector<std::byte> sink(bytes);
    if (::send(ends[0], probe.data(), bytes, MSG_DONTWAIT) == static_cast<ssize_t>(bytes)) {
      [[maybe_unused]] const auto drained = ::recv(ends[1], sink.data(), bytes, 0);
      break;
    }
    ::close(ends[0]), ::close(ends[1]);
  }
  return ends;
}

Transport over_socket(std::size_t bytes) {
  const auto ends = socket_pair_for(bytes);
  const timeval patience{2, 0};
  ::setsockopt(ends[1], SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const auto memory = std::make_shared<std::vector<std::uint64_t>>(bytes / 8);
  const auto block = reinterpret_cast<Block*>(memory->data());
  const auto produce = [=, keep = memory](std::uint64_t number) {
    fill(*block, number, bytes);
    block->header.origin_ns = block->header.published_ns = now_ns();
    for (std::size_t done = 0; done < bytes;) {
      const auto sent = ::send(ends[0], reinterpret_cast<const std::byte*>(block) + done, bytes - done, MSG_NOSIGNAL);
      if (sent <= 0) std::exit(1);
      done += static_cast<std::size_t>(sent);
    }
  };
  const auto consume = [=, keep = memory](const std::function<bool(const Block&)>& take) {
    do
      for (std::size_t done = 0; done < bytes;) {
        const auto got = ::recv(ends[1], reinterpret_cast<std::byte*>(block) + done, bytes - done, 0);
        if (got <= 0) return;
        done += static_cast<std::size_t>(got);
      }
    while (take(*block));
  };
  return {produce, consume};
}

/// A rig's daemons run with real-time priority on cores of their own; where that is not allowed, as well as we can.
void take_core(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<unsigned>(core), &cores);
  ::sched_setaffinity(0, sizeof cores, &cores);
  sched_param priority{.sched_priority = 40};
  ::sched_setscheduler(0, SCHED_FIFO, &priority);
}

void run_consumer(const Transport& transport, Record& record) {
  take_core(1);
  const auto start_ns = now_ns();
  record.ready = 1;
  transport.consume([&](const Block& block) {
    const auto seen_ns = now_ns();
    benchmark::DoNotOptimize(sum(block));
    const auto at = static_cast<std::size_t>(record.count++);
    record.seen_ns[at] = seen_ns - block.header.published_ns;
    record.consumed_ns[at] = now_ns() - block.header.origin_ns;
    return block.header.frame_id < kMessages && record.count < kMessages;
  });
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto cpu_us =
      (usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) * 1e6 + static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  record.cpu_share = cpu_us / ns_to_us(now_ns() - start_ns);
}

void run_producer(const Transport& transport, const Record& record) {
  take_core(0);
  while (!record.ready) ::usleep(200);
  const auto start_ns = now_ns() + 5'000'000;
  for (std::int64_t number = 1; number <= kMessages; ++number) {
    const auto due_ns = start_ns + number * kPeriod_ns;
    sleep_until_ns(due_ns - 100'000);
    while (now_ns() < due_ns) continue;
    transport.produce(static_cast<std::uint64_t>(number));
  }
}

pid_t spawn(const std::function<void()>& body) {
  const auto pid = ::fork();
  if (pid != 0) return pid;
  body();
  ::_exit(0);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}
double median(const std::vector<double>& values) { return quantile(values, 0.5); }

/// One figure per round.
struct Figures {
  std::vector<double> seen_p50_us, seen_p90_us, consumed_p50_us, consumed_p90_us, cpu_percent;
  int lost = 0;
};

void measure(const Transport& transport, Figures& figures) {
  auto* memory = ::mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  auto* record = new (memory) Record;
  const auto consumer = spawn([&] { run_consumer(transport, *record); });
  const auto producer = spawn([&] { run_producer(transport, *record); });
  ::waitpid(producer, nullptr, 0);
  ::waitpid(consumer, nullptr, 0);
  std::vector<double> seen_us, consumed_us;
  for (int i = kWarmUp; i < record->count; ++i) {
    seen_us.push_back(ns_to_us(record->seen_ns[static_cast<std::size_t>(i)]));
    consumed_us.push_back(ns_to_us(record->consumed_ns[static_cast<std::size_t>(i)]));
  }
  figures.seen_p50_us.push_back(quantile(seen_us, 0.5));
  figures.seen_p90_us.push_back(quantile(seen_us, 0.9));
  figures.consumed_p50_us.push_back(quantile(consumed_us, 0.5));
  figures.consumed_p90_us.push_back(quantile(consumed_us, 0.9));
  figures.cpu_percent.push_back(100 * record->cpu_share);
  figures.lost += kMessages - record->count;
  ::munmap(memory, sizeof(Record));
}

const std::vector<std::string> kTransports{"ring, spin", "ring, predictive", "ring, futex", "Unix socket"};

using Table = std::map<std::string, Figures>;

Table measure_all(std::size_t bytes) {
  Table table;
  for (int round = 0; round < kRounds; ++round) {
    measure(over_ring(bytes, ipc::Wait::spin), table["ring, spin"]);
    measure(over_ring(bytes, ipc::Wait::predictive), table["ring, predictive"]);
    measure(over_ring(bytes, ipc::Wait::futex), table["ring, futex"]);
    measure(over_socket(bytes), table["Unix socket"]);
  }
  return table;
}

void print(const Table& table, std::size_t bytes) {
  fmt::print("\n{} B at 525 Hz between two processes, medians of {} rounds of {} messages\n", bytes, kRounds, kMessages - kWarmUp);
  fmt::print("{:<18} {:>22} {:>25} {:>14} {:>12} {:>6}\n", "", "sent->seen us p50 (p90)", "ready->consumed us p50 (p90)", "/ socket (p50)",
             "consumer CPU", "lost");
  const auto socket_us = median(table.at("Unix socket").consumed_p50_us);
  const auto socket_seen_us = median(table.at("Unix socket").seen_p50_us);
  for (const auto& name : kTransports) {
    const auto& f = table.at(name);
    fmt::print("{:<18} {:>13.2f} ({:>7.2f}) {:>18.2f} ({:>7.2f}) {:>6.3f} {:>7.3f} {:>10.1f} % {:>6}\n", name, median(f.seen_p50_us),
               median(f.seen_p90_us), median(f.consumed_p50_us), median(f.consumed_p90_us), median(f.seen_p50_us) / socket_seen_us,
               median(f.consumed_p50_us) / socket_us, median(f.cpu_percent), f.lost);
  }
}

struct Goal {
  std::string name;
  double value;
  double limit;
};

std::vector<Goal> goals_of(const Table& poses, const Table& frames) {
  const auto seen = [&](const char* name) { return median(poses.at(name).seen_p50_us); };
  const auto consumed = [&](const char* name) { return median(frames.at(name).consumed_p50_us); };
  return {{"ring publish->seen p50, 2 KiB, predictive / Unix socket", seen("ring, predictive") / seen("Unix socket"), 0.10},
          {"ring 388,800 B ready->consumed (copied) / Unix socket", consumed("ring, predictive") / consumed("Unix socket"), 0.6}};
}

void write(const std::vector<Goal>& goals, const std::string& path) {
  std::ofstream file(path);
  file << "{\"goals\": [";
  const char* separator = "";
  for (const auto& goal : goals) {
    file << separator
         << fmt::format(R"(
  {{"name": "{}", "value": {:.4f}, "limit": {}, "unit": "ratio", "met": {}}})",
                        goal.name, goal.value, goal.limit, goal.value <= goal.limit);
    separator = ",";
  }
  file << "\n]}\n";
}

void loan_and_publish(benchmark::State& state) {
  const auto segment = must(ipc::Segment::create(ipc::RingSpec::of<Block>("bench", 4, false)));
  auto writer = must(ipc::Writer<Block>::attach(again(segment)));
  std::vector<ipc::Reader<Block>> readers;
  for (int i = 0; i < state.range(0); ++i) readers.push_back(must(ipc::Reader<Block>::attach(again(segment))));
  for (auto _ : state) writer.publish(writer.loan());
}
BENCHMARK(loan_and_publish)->Arg(0)->Arg(ipc::kReaderRows)->ArgName("readers")->MinTime(0.2);

void read_hot(benchmark::State& state) {
  const auto bytes = static_cast<std::size_t>(state.range(0));
  const auto segment = must(ipc::Segment::create(ipc::RingSpec::of<Block>("bench", 4, false, bytes)));
  auto writer = must(ipc::Writer<Block>::attach(again(segment)));
  auto reader = must(ipc::Reader<Block>::attach(again(segment)));
  auto loan = writer.loan();
  fill(*loan, 1, bytes);
  writer.publish(std::move(loan));
  for (auto _ : state) benchmark::DoNotOptimize(reader.at(0));
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
}
BENCHMARK(read_hot)->Arg(kPoses_bytes)->Arg(kFrame_bytes)->ArgName("bytes")->MinTime(0.2);

}  // namespace
}  // namespace handcast

int main(int argc, char** argv) {
  using namespace handcast;
  std::string goals_path;
  std::vector<char*> rest(argv, argv + argc);
  for (auto at = rest.begin(); at != rest.end(); ++at)
    if (std::strcmp(*at, "--goals") == 0 && at + 1 != rest.end()) {
      goals_path = *(at + 1);
      rest.erase(at, at + 2);
      break;
    }
  argc = static_cast<int>(rest.size());
  benchmark::Initialize(&argc, rest.data());
  benchmark::RunSpecifiedBenchmarks();
  std::fflush(stdout);
  const auto poses = measure_all(kPoses_bytes);
  const auto frames = measure_all(kFrame_bytes);
  print(poses, kPoses_bytes);
  print(frames, kFrame_bytes);
  if (!goals_path.empty()) write(goals_of(poses, frames), goals_path);
}
