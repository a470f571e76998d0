// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "services/evaluation/chart/methods.hpp"
#include "services/evaluation/chart/results.hpp"

namespace handcast::chart {

/// One method at one speed: means over motions and seeds.
struct Standing {
  Method method;
  double speed = 1;  ///< times the motion's own
  std::size_t runs = 0;
  /// photon_ms: with the time that a frame takes, where frames were timed alone; the paper's as
  /// published.
  std::optional<double> photon_ms, mean_mm, p95_mm, coverage, spill, jitter_px;
  std::optional<double> landmarks_ms;  ///< their age
  std::optional<double> frame_us;      ///< median on one core; of this machine
};

struct Ladder {
  std::vector<double> speeds;  ///< at most two: natural, and the fastest
  std::vector<Standing> standings;
  bool timed_alone = false;  ///< the frame times are of the plan that times frames and nothing else

  std::vector<Standing> at(double speed) const;
};

/// Of the results in which nothing but motion, speed and seed differs.
Ladder ladder_of(const Results& results);

/// "natural speed", "3 times as fast".
std::string name_of_speed(double speed);

}  // namespace handcast::chart
