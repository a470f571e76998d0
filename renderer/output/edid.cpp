// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/edid.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace handcast::renderer {

std::string model_of(std::span<const std::uint8_t> edid) {
  constexpr std::array<std::uint8_t, 8> kHeader{0, 255, 255, 255, 255, 255, 255, 0};
  constexpr std::size_t kBlock = 128, kFirst = 54, kDescriptor = 18, kText = 5;
  if (edid.size() < kBlock || !std::equal(kHeader.begin(), kHeader.end(), edid.begin()) ||
      std::accumulate(edid.begin(), edid.begin() + kBlock, 0) % 256 != 0)
    return {};
  for (std::size_t at = kFirst; at + kDescriptor < kBlock; at += kDescriptor) {
    const auto descriptor = edid.subspan(at, kDescriptor);
    if (descriptor[0] != 0 || descriptor[1] != 0 || descriptor[3] != 0xFC) continue;
    std::string name;
    for (const std::uint8_t c : descriptor.subspan(kText)) {
      if (c == '\n') break;
      if (c >= ' ' && c < 127) name += static_cast<char>(c);
    }
    while (!name.empty() && name.back() == ' ') name.pop_back();
    return name;
  }
  return {};
}

}  // namespace handcast::renderer
