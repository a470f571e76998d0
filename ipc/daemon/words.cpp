// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/words.hpp"

#include <unistd.h>

#include <array>
#include <string_view>

#include "ipc/daemon/contract.hpp"

namespace handcast::daemon {

Words read_words(int ready_fd) {
  std::array<char, 64> bytes;
  const auto count = ::read(ready_fd, bytes.data(), bytes.size());
  if (count < 0) return {};
  if (count == 0) return {.closed = true};
  const std::string_view text(bytes.data(), static_cast<std::size_t>(count));
  return {.any = true, .ready = text.find(kReadyWord) != std::string_view::npos};
}

bool give_turn(int standby_fd) { return ::write(standby_fd, &kTurnWord, 1) == 1; }

}  // namespace handcast::daemon
