// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/rings_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using ipc::Hold;
using ipc::Wait;

constexpr std::size_t kPoses_bytes = 2048;
constexpr std::size_t kImage_bytes = 720 * 540;

struct Waiting {
  const char* name;
  Wait wait;
};
constexpr Waiting kWaits[] = {{"spin", Wait::spin},
                              {"predictive", Wait::predictive},
                              {"futex", Wait::futex},
                              {"eventfd", Wait::eventfd}};

constexpr std::string_view kSocket = "Unix socket";
#ifdef HANDCAST_WITH_ZEROMQ
constexpr std::string_view kZeroMq = "ZeroMQ ipc push/pull", kCompared = kZeroMq;
constexpr std::string_view kComparedHeading = "/ ZeroMQ";
#else
constexpr std::string_view kCompared = kSocket;
constexpr std::string_view kComparedHeading = "/ socket";
#endif

void add_rings(Table& table, Hold hold) {
  for (const auto& [name, wait] : kWaits)
    table.rows.push_back(
        {.name = fmt::format("ring, {}, {}", name, hold == Hold::lease ? "leased" : "copied"),
         .bytes = table.bytes,
         .make = [bytes = table.bytes, wait = wait, hold] {
           return over_ring(bytes, wait, hold);
         }});
}

void add_others(Table& table) {
  const auto bytes = table.bytes;
  table.rows.push_back({.name = std::string(kSocket), .bytes = bytes, .make = [bytes] {
                          return over_socket(bytes);
                        }});
#ifdef HANDCAST_WITH_ZEROMQ
  table.rows.push_back({.name = std::string(kZeroMq), .bytes = bytes, .make = [bytes] {
                          return over_zeromq(bytes);
                        }});
#endif
}

}  // namespace

const Row& Table::row(std::string_view name) const {
  const auto found = std::ranges::find(rows, name, &Row::name);
  if (found == rows.end()) give_up(fmt::format("nothing was measured as '{}'", name));
  return *found;
}

Table table_of_poses() {
  Table table{kPoses_bytes, {}};
  add_rings(table, Hold::copy);
  add_others(table);
  return table;
}

Table table_of_images() {
  Table table{kImage_bytes, {}};
  add_rings(table, Hold::copy);
  add_rings(table, Hold::lease);
  add_others(table);
  return table;
}

void print(const Table& table) {
  const auto rounds = table.rows.front().seen_p50_us.size();
  fmt::print("\n{} B at {} Hz between two processes, in us: medians of {} rounds of {} messages\n",
             table.bytes, kRate_hz, rounds, kMessages - kWarmUp);
  fmt::print("{:<26} {:>21} {:>22} {:>9} {:>14} {:>6}\n", "", "publish->seen", "ready->consumed",
             kComparedHeading, "consumer's CPU", "lost");
  fmt::print("{:<26} {:>10} {:>10} {:>11} {:>10}\n", "", "p50", "p99", "p50", "p99");
  const auto compared_us = median(table.row(kCompared).consumed_p50_us);
  for (const auto& row : table.rows)
    fmt::print("{:<26} {:>10.2f} {:>10.2f} {:>11.2f} {:>10.2f} {:>9.3f} {:>12.1f} % {:>6}\n",
               row.name, median(row.seen_p50_us), median(row.seen_p99_us),
               median(row.consumed_p50_us), median(row.consumed_p99_us),
               median(row.consumed_p50_us) / compared_us, median(row.cpu_percent), row.lost);
}

std::vector<Goal> goals_of(const Table& poses, const Table& images) {
  const auto seen = [&](std::string_view name) { return median(poses.row(name).seen_p50_us); };
  const auto consumed = [&](std::string_view name) {
    return median(images.row(name).consumed_p50_us);
  };
  const auto predictive = "ring, predictive, copied", leased = "ring, predictive, leased";
  std::vector<Goal> goals{
      {"2 KiB publish->seen p50, predictive / spinning",
       seen(predictive) / seen("ring, spin, copied"), 1.5, "times"},
      {"predictive wait, of a core at 525 Hz", median(poses.row(predictive).cpu_percent), 6, "%"},
      {"388,800 B ready->consumed p50, leased / copied", consumed(leased) / consumed(predictive),
       0.6, "times"},
  };
#ifdef HANDCAST_WITH_ZEROMQ
  goals.push_back({"2 KiB publish->seen p50, predictive / ZeroMQ", seen(predictive) / seen(kZeroMq),
                   0.01, "times"});
  goals.push_back({"388,800 B ready->consumed p50, leased / ZeroMQ",
                   consumed(leased) / consumed(kZeroMq), 0.15, "times"});
#endif
  return goals;
}

}  // namespace handcast::bench
