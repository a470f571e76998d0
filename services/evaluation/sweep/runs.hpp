// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "services/evaluation/sweep/plan.hpp"

namespace handcast::sweep {

/// One run of a plan. The order is fixed: variant by variant, within it grid by grid, each with its
/// last axis turning fastest.
struct Run {
  std::size_t index = 0;
  std::size_t variant = 0;           ///< in Plan::variants
  std::size_t grid = 0;              ///< in Plan::grids
  std::vector<std::size_t> choices;  ///< one per axis of that grid

  /// What a setting is in this run; null where its grid does not turn it.
  const Choice* choice(const Plan& plan, const std::string& path) const;
};

/// Every run of the plan, and a number (hexadecimal) that two plans share only where every run of
/// both is the same: rig files, settings and times together. Paths count relative to the plan, so
/// that it is the same on every machine.
struct Expansion {
  std::vector<Run> runs;
  std::string fingerprint;
};

/// Errors: bad_config, where settings that are each right do not go together; every such sentence
/// once, with the first run it is about.
Result<Expansion> expand(const Plan& plan);

/// The rig of one run.
Result<config::Rig> rig_of(const Plan& plan, const Run& run);

/// "one_euro, twin.speed=2".
std::string describe_run(const Plan& plan, const Run& run);

/// Why this machine cannot do a run: its motion is a folder that is not there.
std::optional<std::string> why_absent(const config::Rig& rig);

/// One part of a sweep that several machines share: the runs whose index is `index` modulo `count`.
struct Shard {
  std::size_t index = 0, count = 1;
  bool has(const Run& run) const { return run.index % count == index; }
};

/// "2/8". Errors: bad_config.
Result<Shard> parse_shard(const std::string& text);

}  // namespace handcast::sweep
