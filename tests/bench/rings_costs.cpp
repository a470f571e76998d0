// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rings_costs.hpp"

#include <functional>
#include <optional>
#include <vector>

#include "ipc/ring/writer.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/rings_process.hpp"
#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {
namespace {

constexpr int kCostSlots = 8;
constexpr int kBatches = 400, kPerBatch = 500;

using CostReader = ipc::Reader<Block>;
using Writer = ipc::Writer<Block>;

double median_ns(const std::function<void()>& work) {
  std::vector<double> batches_us;
  for (int batch = 0; batch < kBatches; ++batch)
    batches_us.push_back(timed_us([&] {
      for (int i = 0; i < kPerBatch; ++i) work();
    }));
  return median(batches_us) * 1000 / kPerBatch;
}

ipc::Segment make_ring(std::size_t bytes) {
  return must(ipc::Segment::create(ipc::RingSpec::of<Block>("bench", kCostSlots, false, bytes)));
}

void read_without_end(const ipc::Segment& segment) {
  auto reader = must(CostReader::attach(again(segment), ipc::Wait::spin));
  for (;;) reader.latest(Deadline::in(std::chrono::seconds(1)));
}

}  // namespace

double loan_and_publish_ns(int readers, bool busy) {
  const auto segment = make_ring(sizeof(Block));
  std::vector<CostReader> attached;
  for (int i = busy ? 1 : 0; i < readers; ++i)
    attached.push_back(must(CostReader::attach(again(segment))));
  std::optional<Process> other;
  if (busy) other.emplace(1, [&] { read_without_end(segment); });
  auto writer = must(Writer::attach(again(segment)));
  return median_ns([&] { writer.publish(writer.loan()); });
}

double take_ns(std::size_t bytes, ipc::Hold hold) {
  const auto segment = make_ring(bytes);
  auto reader = must(CostReader::attach(again(segment), ipc::Wait::futex, hold));
  auto writer = must(Writer::attach(again(segment)));
  auto block = writer.loan();
  fill(*block, 1, bytes);
  writer.publish(std::move(block));
  return median_ns([&] { must(reader.at(0)); });
}

}  // namespace handcast::bench
