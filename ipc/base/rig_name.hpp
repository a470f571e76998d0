// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string_view>

namespace handcast {

/// What the name of a rig must be, for messages.
inline constexpr std::string_view kRigNameRule = "use up to 48 letters, digits, '_' and '-'";

/// True if this can be the name of a rig. Such names are parts of the names of files, sockets and
/// systemd's units.
constexpr bool is_rig_name(std::string_view name) {
  constexpr std::size_t kLongest = 48;
  constexpr std::string_view kCharacters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !name.empty() && name.size() <= kLongest &&
         name.find_first_not_of(kCharacters) == std::string_view::npos;
}

}  // namespace handcast
