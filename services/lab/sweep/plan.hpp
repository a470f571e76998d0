// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::sweep {

/// One value of a setting in a plan.
struct Choice {
  std::string shown;     ///< the text in the plan, --list and the CSV; the same on all machines
  std::string assigned;  ///< the value to be set: files and folders are absolute
  int line = 0;          ///< line of the plan
};

/// A setting and its values: one if it is fixed, several if it is an axis of a grid.
struct Axis {
  std::string path;             ///< of the setting, as in config/REFERENCE.md
  std::vector<Choice> choices;  ///< at least one
};

/// All combinations of the values of its axes.
using Grid = std::vector<Axis>;

/// A named rig with settings of its own: changes several settings at once.
struct Variant {
  std::string name;                ///< unique in the plan
  std::filesystem::path rig_file;  ///< absolute
  std::string rig_text;            ///< content of rig_file
  std::vector<Axis> settings;      ///< fixed settings
  /// Folders with the results of another method that take the place of the tracker's and of the
  /// detector's, a file for each case: see results_file(). Absolute; "" for none.
  /// @{
  std::filesystem::path poses{}, landmarks{};
  /// @}
};

/// The content of a plan file. The paths in it are relative to the file.
///
///     rig = "../rigs/twin.toml"        # of the variants without a rig of their own
///     seconds = 5
///     warm_up_s = 0.5
///     draw_every = 24                  # draws and scores every 24th projector frame
///     draw_hz = 30                     # instead: about so many frames a second, of any projector
///     joints_only = false              # true: draws nothing and scores only the 21 landmarks
///     settings_from = "worlds/a.toml"  # settings of all runs that several plans share; those of
///                                      # the plan itself and its axes take precedence
///     [settings]                       # of all runs
///     twin.tracker.age_ms = 15
///     [[variant]]                      # without any, the rig is the only variant
///     name = "paper"
///     settings.cascade.filter.method = "paper"
///     [[variant]]
///     name = "paper_held"
///     from = ["paper"]              # the settings of variants above, and the rig of the first
///                                      # of them; the last count most, and its own before all
///     settings.cascade.predict.method = "hold"
///     [[variant]]
///     name = "mine"
///     landmarks = "mine"               # or poses: the folder of a method's results
///     [grid]                           # all combinations are run
///     twin.motion = ["builtin:wave", "../../data/wave"]
///     twin.speed = [1, 2, 3]
///
/// Several grids, each a [[grid]], are run one after the other. In the runs of one grid, the axes
/// of the others have the values of the rig.
struct Plan {
  std::string name;               ///< file name without its extension
  std::filesystem::path file;     ///< the file itself
  double seconds = 5;             ///< scored time of a run
  double warm_up_s = 0.5;         ///< time before it that is not scored
  int draw_every = 24;            ///< 0 if joints_only
  double draw_hz = 0;             ///< takes the place of draw_every if it is greater than 0
  std::vector<Axis> settings;     ///< fixed settings of all runs
  std::vector<Variant> variants;  ///< at least one
  std::vector<Grid> grids;        ///< at least one, possibly without axes

  /// The paths of all axes of all grids, in the order of the file.
  std::vector<std::string> axes() const;
};

/// Reads a plan file. Errors: bad_config; the message holds all faults of the plan, a line each:
/// "PLAN:LINE: path: sentence".
Result<Plan> load_plan(const std::filesystem::path& file);

/// The same for the text of a plan. Its paths are relative to `file`, which need not exist.
Result<Plan> parse_plan(const std::string& toml, const std::filesystem::path& file);

}  // namespace handcast::sweep
