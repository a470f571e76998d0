// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

namespace handcast::landmarks {

/// e^x for x <= 88, with a relative error below 3e-7; an x below -87, or not a number, counts as
/// -87. Written so that the compiler vectorises loops over it. Computes 2^n e^r with |r| <= ln 2 /
/// 2: ln 2 is split into two constants, which keeps r exact, and the Taylor series ends at the
/// precision of a float.
inline float exponential(float x) {
  constexpr float kToWhole = 12582912.0f;  // 1.5 * 2^23: adding it rounds to whole numbers
  const float least = std::max(-87.0f, x);
  const float n = (least * 1.44269504f + kToWhole) - kToWhole;
  const float r = (least - n * 0.693359375f) + n * 2.12194440e-4f;
  const float series =
      1 + r * (1 + r * (0.5f + r * (1.0f / 6 + r * (1.0f / 24 + r * (1.0f / 120 + r / 720)))));
  return series * std::bit_cast<float>((static_cast<std::int32_t>(n) + 127) << 23);
}

}  // namespace handcast::landmarks
