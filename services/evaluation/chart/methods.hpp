// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "services/evaluation/chart/palette.hpp"

namespace handcast::chart {

/// What charts know of a variant by its name.
struct Method {
  std::string variant, label;
  Colour colour = kInk;
  std::optional<int> freedoms = {};  ///< of the correction, per hand; only rungs have a number
  bool detects = false;  ///< handcast with a real detector on the twin's images, as old as it is
};

/// The rungs of the ladder, cheapest first.
std::span<const Method> rungs();

/// Of a variant that nobody knows: its name, in the colour of text.
Method method_of(std::string_view variant);

/// The three that every chart compares.
inline constexpr std::string_view kCompared[] = {"baseline", "paper", "handcast"};

}  // namespace handcast::chart
