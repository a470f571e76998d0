// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/desk/base/panel.hpp"
#include "services/desk/base/surface.hpp"
#include "services/desk/cues/cue_list.hpp"

namespace handcast::desk::knobs {

/// What a hand does, as an amount.
enum class Amount { there, pinch, spread, fist, open, point, palm_up, speed, touch };

/// Where the value of a setting comes from.
struct Source {
  /// Which hand; `either`: the one with the larger amount; `nobody`: 1 while no hand is there.
  enum class Whose { left, right, either, nobody };
  Whose whose = Whose::left;
  Amount amount = Amount::pinch;

  /// The amount now; empty if there is no such hand.
  std::optional<double> at(const Scene& scene) const;
};

/// A setting that a hand turns.
struct GestureKnob {
  std::size_t control = 0;  ///< its place in Panel::controls()
  Source source;
  std::string source_name;     ///< "right.pinch"
  double from = 0, to = 1;     ///< the amounts at the ends of the way
  double first = 0, last = 1;  ///< the values there: numbers, 0 and 1, or places of words
  cues::Curve curve = cues::Curve::linear;
  double smooth_s = 0.1;  ///< time constant
  bool returns = false;   ///< when the hand leaves, the value is that of before
  std::size_t steps = 0;  ///< a switch, words or whole numbers: how many values; 0: a number
};

/// Reads the settings that hands turn:
///
///     [[gesture]]
///     path = "light.master"
///     source = "right.pinch"   # left, right, either; there, pinch, spread, fist, open, point,
///                              # palm_up, speed, touch; or "nobody"
///     from = 0.2               # the amounts at the ends of the way; if left out, all of it
///     to = 0.9
///     min = 0                  # the values there; if left out, the range of the setting
///     max = 1
///     curve = "linear"         # linear, ease, s-curve
///     smooth_s = 0.1
///     gone = "hold"            # or "return": what happens when the hand leaves
///
/// `controls`: of the panel. Errors: bad_config (all faults, each with file and line).
/// @{
Result<std::vector<GestureKnob>> read_gestures(const std::filesystem::path& file,
                                               std::span<const Control> controls);
Result<std::vector<GestureKnob>> parse_gestures(const std::string& toml, std::string_view file,
                                                std::span<const Control> controls);
/// @}

}  // namespace handcast::desk::knobs
