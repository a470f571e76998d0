// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>

namespace handcast::renderer {

/// Eight pixels of a mask at once, the first in the lowest byte of a little-endian machine.
/// `pixels` may have any alignment.
inline std::uint64_t load_eight(const std::uint8_t* pixels) {
  std::uint64_t word;
  std::memcpy(&word, pixels, sizeof word);
  return word;
}

}  // namespace handcast::renderer
