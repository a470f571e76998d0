// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast {

inline constexpr std::int64_t kMs = 1'000'000;  ///< a millisecond in ns

}  // namespace handcast
