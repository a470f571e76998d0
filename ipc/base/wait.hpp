// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

namespace handcast::ipc {

/// How a reader waits for the next message (ipc/ring/README.md, "Waiting").
enum class Wait {
  /// Polls without sleeping: sees a message within 1 us, uses one core.
  spin,
  /// Sleeps until shortly before the next message of a regular stream is due, then polls: nearly as
  /// fast as `spin`, uses about 5 % of a core.
  predictive,
  /// Sleeps until the writer wakes it, which takes 30 to 60 us.
  futex,
  /// Like `futex`, with a descriptor for epoll; takes about 30 us longer.
  eventfd,
};
/// The words of the setting, in the order of the enumerators.
constexpr std::array<std::string_view, 4> words_of(Wait) {
  return {"spin", "predictive", "futex", "eventfd"};
}

}  // namespace handcast::ipc
