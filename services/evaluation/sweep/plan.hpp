// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::sweep {

/// One value a setting takes in a plan.
struct Choice {
  std::string
      shown;  ///< as the plan says it: what --list and the CSV print, the same on every machine
  std::string assigned;  ///< what stands behind "path=": files and folders are absolute
  int line = 0;
};

/// A setting (any path of config/REFERENCE.md) and what it is: one choice where it is fixed,
/// several along an axis of the grid.
struct Axis {
  std::string path;
  std::vector<Choice> choices;
};

/// Every combination of the choices of its axes.
using Grid = std::vector<Axis>;

/// A rig with settings of its own, under a name: where one word is to change several settings at
/// once.
struct Variant {
  std::string name;
  std::filesystem::path rig_file;
  std::string rig_text;  ///< of that file, read once
  std::vector<Axis> settings;
};

/// What a plan file says. Every path in it is relative to the file.
///
///     rig = "../rigs/twin.toml"        # of the variants that name none
///     seconds = 5
///     warm_up_s = 0.5
///     draw_every = 24                  # projector frames from one drawn and scored to the next
///     joints_only = false              # true: nothing is drawn, only the 21 landmarks are scored
///     [settings]                       # of every run
///     twin.tracker.age_ms = 15
///     [[variant]]                      # of one rung; without any: the rig as it is
///     name = "one_euro"
///     settings.cascade.filter.method = "one_euro"
///     [grid]                           # every combination
///     twin.motion = ["builtin:wave", "../../data/wave"]
///     twin.speed = [1, 2, 3]
///
/// Several grids, each a [[grid]], are run one after the other; what one does not name is in it as
/// the rig has it.
struct Plan {
  std::string name;  ///< the file's, without its ending
  std::filesystem::path file;
  double seconds = 5;
  double warm_up_s = 0.5;
  int draw_every = 24;  ///< 0: joints only
  std::vector<Axis> settings;
  std::vector<Variant> variants;
  std::vector<Grid> grids;  ///< at least one, and be it empty

  /// Every setting that any grid turns, in the order of the file.
  std::vector<std::string> axes() const;
};

/// Errors: bad_config; every fault of the plan at once, a line each, "PLAN:LINE: path: sentence".
Result<Plan> load_plan(const std::filesystem::path& file);

/// The same from memory.
Result<Plan> parse_plan(const std::string& toml, const std::filesystem::path& file);

}  // namespace handcast::sweep
