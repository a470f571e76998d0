// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/desk/base/panel.hpp"

namespace handcast::desk::cues {

/// How a number goes from its value to that of a cue.
enum class Curve {
  linear,
  ease,     ///< fast at first, slow at the end
  s_curve,  ///< slow at both ends
};
/// How much of the way is done at a share of the time; both 0..1.
double progress(Curve curve, double share);

/// A setting of a cue.
struct Target {
  std::size_t control = 0;      ///< its place in Panel::controls()
  std::vector<double> numbers;  ///< what fades: a number, or a list of them
  std::string assignment;       ///< otherwise what it switches to: "light.freeze=true"
  double fade_s = 0;
  Curve curve = Curve::linear;
};

/// What starts a cue by itself.
struct Trigger {
  enum class Kind {
    key,    ///< CueDeck::key()
    event,  ///< one of Scene::events
    at,     ///< a time of day
    idle,   ///< no hand has been there for some time
    after,  ///< some time after the cue before it was started
  };
  Kind kind = Kind::key;
  std::string name;    ///< key, event
  double seconds = 0;  ///< at: since midnight; idle, after: how long
};

/// A cue.
struct Cue {
  std::string name;
  std::vector<std::pair<std::string, std::string>> content;  ///< hand and content
  std::vector<Target> targets;
  std::vector<Trigger> triggers;

  /// How long all of it takes, s.
  double longest_fade_s() const;
};

/// A cue list.
struct CueList {
  bool loops = false;  ///< behind the last cue comes the first
  std::vector<Cue> cues;
};

/// Reads a cue list:
///
///     loop = true                       # if left out: false
///     [[cue]]
///     name = "Darkness"                 # if left out: its number
///     on = ["key d", "at 20:15", "left.appears", "idle 30", "after 5"]
///     left = "tiger"                    # right, both; files are relative to the cue list
///     transition = "isf:wipe.fs"        # content.transition and content.transition_s
///     transition_s = 2
///     fade_s = 3                        # of all numbers
///     curve = "s-curve"                 # linear, ease, s-curve
///     set.light.master = 0.2
///     set.projector.brightness = { to = 0.5, fade_s = 10, curve = "linear" }
///
/// `controls`: of the panel. Errors: bad_config (all faults, each with file and line).
/// @{
Result<CueList> read_cues(const std::filesystem::path& file, std::span<const Control> controls);
Result<CueList> parse_cues(const std::string& toml, std::string_view file,
                           std::span<const Control> controls);
/// @}

}  // namespace handcast::desk::cues
