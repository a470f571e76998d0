// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

namespace handcast::chart {

/// A colour of charts. SVG files use the value; on the page it is replaced by the CSS variable of
/// the style sheet, which also has a dark colour scheme.
struct Colour {
  std::string_view name;   ///< CSS variable, without "--"
  std::string_view value;  ///< "#rrggbb" in the light colour scheme
};

/// Surfaces, text and lines.
/// @{
inline constexpr Colour kPanel{"panel", "#ffffff"}, kInk{"ink", "#22252a"},
    kQuiet{"quiet", "#686d76"}, kLine{"line", "#e2dfd9"};
/// @}
/// The bands of unnoticed delay: without and with the fill.
/// @{
inline constexpr Colour kNear{"near", "#e3efe9"}, kFar{"far", "#f3f1e7"};
/// @}
/// Methods. Baseline, paper and ours also differ in lightness, for readers who cannot distinguish
/// the hues.
/// @{
inline constexpr Colour kBaseline{"baseline", "#8d939c"}, kPaper{"cascade", "#c58a2c"},
    kOurs{"ours", "#14806a"}, kFast{"fast", "#3b5fa0"};
/// @}

/// All of the above.
inline constexpr std::array kColours{kPanel, kInk,      kQuiet, kLine, kNear,
                                     kFar,   kBaseline, kPaper, kOurs, kFast};

}  // namespace handcast::chart
