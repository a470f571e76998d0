// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::bridge {

inline constexpr std::int64_t kUs = 1'000, kMs = 1'000'000, kSecond = 1'000'000'000;

}  // namespace handcast::bridge
