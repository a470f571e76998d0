// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstddef>
#include <string_view>

namespace handcast {

/// Writes text to a descriptor whose reader may be slow or have stopped: a terminal, a pipe or a
/// socket. One thread at a time.
class ImpatientWriter {
 public:
  /// Makes writing to the descriptor, which stays the caller's, not block: it then refers to a file
  /// of its own, because O_NONBLOCK of the one it shares with other programs would hit these, too.
  /// What cannot be opened anew (a socket, a terminal of another user) is only written when poll(2)
  /// says that it is ready.
  ImpatientWriter(int fd, std::chrono::milliseconds patience);

  /// Writes text. Waits up to `patience` for a reader that is merely slow, but not again before it
  /// has taken all of a text. False if a part of it is lost. A reader that is gone takes
  /// everything.
  bool takes(std::string_view text);
  /// True if the last line that was taken has no end.
  bool is_cut() const { return is_cut_; }

 private:
  std::size_t write_some(std::string_view text) const;

  int fd_;
  std::chrono::milliseconds patience_;
  bool is_cut_ = false;
  bool is_waited_for_ = true;
};

}  // namespace handcast
