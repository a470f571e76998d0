// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <string_view>

namespace handcast::test {

/// A block of EDID whose third descriptor is a name of at most 13 characters.
inline std::array<std::uint8_t, 128> edid_with(std::string_view name) {
  constexpr std::size_t kTiming = 54, kName = 54 + 2 * 18;
  std::array<std::uint8_t, 128> edid{0, 255, 255, 255, 255, 255, 255, 0};
  edid[kTiming] = 1;
  edid[kName + 3] = 0xFC;
  std::ranges::copy(name, edid.begin() + kName + 5);
  edid[127] = static_cast<std::uint8_t>(256 - std::accumulate(edid.begin(), edid.end(), 0) % 256);
  return edid;
}

}  // namespace handcast::test
