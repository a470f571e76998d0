// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "services/lab/chart/methods.hpp"
#include "services/lab/chart/results.hpp"

namespace handcast::chart {

/// The figures of one method at one speed: means over motions and seeds, empty if not measured.
struct Standing {
  Method method;         ///< the variant
  double speed = 1;      ///< factor of the motion's own speed
  std::size_t runs = 0;  ///< number of runs
  /// Motion to photon. The simulated software time is replaced by the measured time of a frame, if
  /// there is one; that of the paper is kept.
  std::optional<double> photon_ms;
  std::optional<double> mean_mm;       ///< interior error, mean
  std::optional<double> p95_mm;        ///< interior error, 95th percentile
  std::optional<double> coverage;      ///< lit share of the hand
  std::optional<double> spill;         ///< light beside the hand, as a share of the hand
  std::optional<double> jitter_px;     ///< of the landmarks on slow hands, camera px
  std::optional<double> landmarks_ms;  ///< age of the landmarks
  std::optional<double> frame_us;      ///< median time of a frame on one core of this machine
};

/// The methods that chart A and chart C compare.
struct Ladder {
  std::vector<double> speeds;       ///< at most two: natural, and the fastest
  std::vector<Standing> standings;  ///< by speed, then by variant; all have p95_mm
  bool timed_alone = false;         ///< the frame times are of the plan "times", which runs alone

  /// The standings of one speed.
  std::vector<Standing> at(double speed) const;
};

/// The ladder of the plans whose only axes are motion, speed and seed.
Ladder ladder_of(const Results& results);

/// Prints a speed: "natural speed", "3 times as fast".
std::string name_of_speed(double speed);

}  // namespace handcast::chart
