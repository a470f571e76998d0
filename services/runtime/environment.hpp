// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace handcast::service {

using RingFds = std::map<std::string, int, std::less<>>;

/// "camera.frames=5,pose.hands=6" as stream → descriptor; what does not parse is left out.
RingFds parse_rings(std::string_view text);

/// A whole number from the environment; empty where it is unset or not a number.
std::optional<std::int64_t> number_from_environment(const char* name);

}  // namespace handcast::service
