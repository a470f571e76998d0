// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "services/camera/leap/calibration_block.hpp"
#include "services/camera/leap/little_endian.hpp"

namespace handcast::test {

/// The block of a controller with round figures of the size that published blocks have: eyes 40 mm
/// apart, focal length 134 px, a field of 150 degrees.
inline std::vector<std::uint8_t> sample_calibration() {
  constexpr std::array<float, 17> kLeft{134,  -0.5f,  4.3f,   7e-4f,  -3e-3f, 1.27f,
                                        0.3f, 0.018f, 1.46f,  0.34f,  -7e-3f, 131.f,
                                        2.7f, 4.9f,   -3e-4f, -4e-3f, 4e-3f};
  constexpr std::array<float, 17> kRight{134,  0.9f,   6.3f,  5e-4f,  -4e-3f, 1.27f,
                                         0.3f, 0.018f, 1.46f, 0.34f,  -7e-3f, 131.f,
                                         4.3f, 4.9f,   5e-3f, -1e-3f, 4e-3f};
  std::vector<std::uint8_t> block(camera::leap::kCalibrationBytes);
  block[0] = 'C';
  block[1] = 'A';
  const auto put = [&](std::size_t at, float value) {
    camera::leap::put_32(block, at, std::bit_cast<std::uint32_t>(value));
  };
  put(8, 40.f);
  put(12, 0.041f);
  for (std::size_t i = 0; i < kLeft.size(); ++i) {
    put(16 + 4 * i, kLeft[i]);
    put(84 + 4 * i, kRight[i]);
  }
  return block;
}

}  // namespace handcast::test
