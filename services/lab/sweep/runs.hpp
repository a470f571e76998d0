// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "services/lab/sweep/plan.hpp"

namespace handcast::sweep {

/// One run of a plan. Runs are ordered by variant, then by grid, then by the values of its axes, of
/// which the last varies fastest.
struct Run {
  std::size_t index = 0;             ///< number of the run in the plan, from 0
  std::size_t variant = 0;           ///< index in Plan::variants
  std::size_t grid = 0;              ///< index in Plan::grids
  std::vector<std::size_t> choices;  ///< index of the value by axis of the grid

  /// The value of a setting in this run; null if it is not an axis of the run's grid.
  const Choice* choice(const Plan& plan, const std::string& path) const;
};

/// All runs of a plan.
struct Expansion {
  std::vector<Run> runs;  ///< in the order of their index
  /// Hexadecimal hash of all runs: rig files, settings, times, and the contents of calibrations,
  /// hands and pictures that rigs name. Paths enter relative to the plan, so that it is the same on
  /// all machines.
  std::string fingerprint;
};

/// Expands a plan into its runs. Errors: bad_config (valid settings that exclude each other, or
/// more than 1,000,000 runs); each message occurs once, with the first run that it concerns.
Result<Expansion> expand(const Plan& plan);

/// The rig of one run. Errors: bad_config (settings that exclude each other).
Result<config::Rig> rig_of(const Plan& plan, const Run& run);

/// Prints the variant and the axes of a run: "paper, twin.speed=2".
std::string describe_run(const Plan& plan, const Run& run);

/// The number of the case of a run: of the same settings of the grids, all variants have the same.
std::size_t case_of(const Plan& plan, const Run& run);
/// The file of a case, 007.npy or 007.csv, in a folder of results (Variant::poses); "" if `folder`
/// is empty.
std::string results_file(const std::filesystem::path& folder, std::size_t number);

/// The reason why this machine cannot do a run, i.e. that the folder of its motion does not
/// exist, WebXR's hand is not installed, or a method has no results of it; empty if it can.
/// @{
std::optional<std::string> why_absent(const config::Rig& rig);
std::optional<std::string> why_absent(const Plan& plan, const Run& run, const config::Rig& rig);
/// @}

/// One part of a sweep on several machines: the runs whose index is `index` modulo `count`.
struct Shard {
  std::size_t index = 0;  ///< less than `count`
  std::size_t count = 1;  ///< number of parts

  /// True if the run is in this part.
  bool has(const Run& run) const { return run.index % count == index; }
};

/// Parses "2/8". Errors: bad_config.
Result<Shard> parse_shard(const std::string& text);

}  // namespace handcast::sweep
