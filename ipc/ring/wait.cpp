// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/wait.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace handcast::ipc {

Result<Wait> parse_wait(std::string_view name) {
  static constexpr std::array<std::string_view, 4> kNames{"spin", "predictive", "futex",
                                                          "eventfd"};  // in the order of Wait
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end())
    return fail(Errc::bad_config, fmt::format("a reader cannot wait by '{}': there are {}", name,
                                              fmt::join(kNames, ", ")));
  return static_cast<Wait>(found - kNames.begin());
}

}  // namespace handcast::ipc
