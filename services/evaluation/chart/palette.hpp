// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

namespace handcast::chart {

/// A colour of charts: in a file of its own as it stands here; on the page as the style sheet has
/// it, which knows dark rooms. Baseline, paper and ours differ in lightness too, so that no eye
/// needs their hues.
struct Colour {
  std::string_view name, value;
};

inline constexpr Colour kPanel{"panel", "#ffffff"}, kInk{"ink", "#22252a"},
    kQuiet{"quiet", "#686d76"}, kLine{"line", "#e2dfd9"}, kNear{"near", "#e3efe9"},
    kFar{"far", "#f3f1e7"}, kBaseline{"baseline", "#8d939c"}, kPaper{"cascade", "#c58a2c"},
    kOurs{"ours", "#14806a"}, kFast{"fast", "#3b5fa0"};

inline constexpr std::array kColours{kPanel, kInk,      kQuiet, kLine, kNear,
                                     kFar,   kBaseline, kPaper, kOurs, kFast};

}  // namespace handcast::chart
