// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

namespace handcast::preview {

/// A time of a message, limited to the first 100 years of the clock: differences of such times do
/// not overflow.
constexpr std::int64_t sane_ns(std::int64_t time_ns) {
  return std::clamp<std::int64_t>(time_ns, 0, 100LL * 366 * 86'400 * 1'000'000'000);
}

}  // namespace handcast::preview
