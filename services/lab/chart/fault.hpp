// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/lab/chart/results.hpp"

namespace handcast::chart {

/// The effect of one failure on one method, over motions and seeds. Empty if not measured.
struct Damage {
  std::optional<double> worst_mm;     ///< largest landmark error; of passing failures only
  std::optional<double> recovery_ms;  ///< longest recovery; of passing failures only
  std::optional<double> dark_ms;      ///< longest time without light; of passing failures only
  std::optional<double> p95_mm;       ///< mean of the interior error's 95th percentile
  std::optional<double> coverage;     ///< mean
  std::optional<double> spill;        ///< mean
  std::optional<double> foldovers;    ///< largest number of a run
  std::size_t runs = 0;               ///< number of runs
  std::size_t never_good = 0;         ///< runs that ended before the light was good again
};

/// The kinds of failure, in the order of the atlas.
enum class FailureKind {
  passing,  ///< a sensor fails for a moment
  lasting,  ///< a sensor or the image is bad for the whole run
  motion,   ///< no failure: a difficult motion
};

/// One failure and its effect.
struct Failure {
  std::string name;                         ///< label in the atlas
  FailureKind kind = FailureKind::passing;  ///< block of the atlas
  std::map<std::string, Damage> damage;     ///< by variant
};

/// Recoveries that differ by no more are the same: two refreshes of the projector.
inline constexpr double kSameRecovery_ms = 2;
/// True if one method recovers from a failure and another one does not, or later.
bool recovers_faster(const Damage& damage, const Damage& than);

/// The failures of the results, ordered by kind. Several faults at once are one failure.
std::vector<Failure> failures_of(const Results& results);

}  // namespace handcast::chart
