// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// The corners of an area, projector px: x, y.
using Polygon = std::vector<std::array<double, 2>>;

/// Reads light.keep_out. Errors: bad_config (too many, or not "x y, x y, x y").
Result<std::vector<Polygon>> parse_keep_out(std::span<const std::string> areas);

}  // namespace handcast::config
