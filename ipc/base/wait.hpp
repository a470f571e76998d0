// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

namespace handcast::ipc {

/// How a reader waits for the next message.
enum class Wait {
  spin,        ///< sees it within 1 us, for a whole core
  predictive,  ///< sleeps until shortly before a regular stream's next message is due: nearly as
               ///< fast, for some 5 % of a core
  futex,       ///< is woken within 30 to 60 us
  eventfd,     ///< as futex, and has a descriptor for epoll: some 30 us more
};
constexpr std::array<std::string_view, 4> words_of(Wait) {
  return {"spin", "predictive", "futex", "eventfd"};
}

}  // namespace handcast::ipc
