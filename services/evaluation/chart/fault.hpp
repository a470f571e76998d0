// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/evaluation/chart/results.hpp"

namespace handcast::chart {

/// What one method did under one failure: means over motions and seeds, the worst of the worst.
struct Damage {
  std::optional<double> worst_mm, recovery_ms, dark_ms;  ///< of failures that pass
  std::optional<double> p95_mm, coverage, spill, foldovers;
  std::size_t runs = 0, never_good = 0;  ///< how many were not good again before their end
};

enum class FailureKind { passing, lasting, motion };

struct Failure {
  std::string name;
  FailureKind kind = FailureKind::passing;
  std::map<std::string, Damage> damage;  ///< by variant
};

/// Every failure of the results: of sensors for a moment, of sensors and images for good, motions
/// that are hard; in this order.
std::vector<Failure> failures_of(const Results& results);

}  // namespace handcast::chart
