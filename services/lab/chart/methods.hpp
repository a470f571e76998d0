// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "services/lab/chart/palette.hpp"

namespace handcast::chart {

/// The presentation of a variant in charts.
struct Method {
  std::string variant;               ///< name in the plan
  std::string label;                 ///< name in charts
  Colour colour = kInk;              ///< of points and lines
  std::optional<int> freedoms = {};  ///< degrees of freedom of the correction per hand; rungs only
  bool detects = false;              ///< handcast with a real detector of measured age
};

/// The rungs of the ladder (`docs/method.md#ladder`), cheapest first.
std::span<const Method> rungs();

/// The method of a variant. An unknown variant has its name as label and the colour of text.
Method method_of(std::string_view variant);

/// The variants that the failure atlas compares.
inline constexpr std::string_view kCompared[] = {"baseline", "paper", "handcast"};

}  // namespace handcast::chart
