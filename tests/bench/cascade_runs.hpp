// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace handcast::bench {

/// One run of a rig on its twin, and its metrics (null where it could not run).
struct SimulatedRun {
  std::string label, motion;
  double speed = 1;
  std::vector<std::string> settings;  ///< beside motion and speed
  int draw_every = 24;                ///< 0: landmarks alone
  nlohmann::json metrics;
};

/// Runs them on twin.toml, `seconds` each, two side by side, with a line of progress every few
/// seconds.
void simulate_all(std::vector<SimulatedRun>& runs, double seconds);

}  // namespace handcast::bench
