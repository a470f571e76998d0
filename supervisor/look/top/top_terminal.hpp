// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <termios.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// The commands of the keyboard; `marks` shows or hides the rings of stage marks.
enum class Key { quit, up, down, page_up, page_down, marks };

/// The keys in the bytes that a terminal sent. Unknown bytes are ignored.
std::vector<Key> keys_in(std::string_view bytes);

/// The full screen of the terminal. It is restored by the destructor (also after SIGINT, SIGTERM
/// and SIGHUP, which wait() reports) and after a crash. Only one object at a time.
class Terminal {
 public:
  /// True if stdin and stdout are both a terminal.
  static bool present();

  /// Switches the terminal to full screen and installs signal handlers.
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;

  /// The size of the screen in characters.
  struct Size {
    /// 80 x 24 if the size is unknown.
    /// @{
    std::size_t columns = 80, rows = 24;
    /// @}
  };
  /// The present size of the screen.
  Size size() const;
  /// Replaces the contents of the screen in one write, without flicker.
  void show(const std::vector<std::string>& lines) const;
  /// Waits until `until_ns` (CLOCK_MONOTONIC) for keys, a signal to quit (Key::quit), or a new size
  /// of the screen (no keys). Empty if nothing happened until then.
  std::optional<std::vector<Key>> wait(std::int64_t until_ns) const;

 private:
  UniqueFd signals_;
};

}  // namespace handcast::supervisor
