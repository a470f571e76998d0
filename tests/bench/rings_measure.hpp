// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/bench/rings_transports.hpp"

namespace handcast::bench {

inline constexpr int kRate_hz = 525;   // the paper's camera
inline constexpr int kMessages = 420;  // per round and transport: below the second in which Linux
                                       // stops a real-time process that spins
inline constexpr int kWarmUp = 40;     // of them, not counted

/// One way of carrying messages of one size, and one figure per round.
struct Row {
  std::string name;
  std::size_t bytes = 0;
  std::function<Transport()> make;
  std::vector<double> seen_p50_us{},
      seen_p99_us{};  ///< from the producer's last stamp to the message in the consumer's hand
  std::vector<double> consumed_p50_us{},
      consumed_p99_us{};              ///< from the payload complete to every byte of it read
  std::vector<double> cpu_percent{};  ///< of a core, the consumer's
  int lost = 0;
};

/// One round: a producer and a consumer, each a process pinned to its core, real-time where
/// permitted.
void measure(Row& row);

}  // namespace handcast::bench
