// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <termios.h>

#include <optional>

#include "ipc/base/result.hpp"

namespace handcast::calibrate {

/// A key of the terminal.
struct Key {
  enum class Arrow { none, up, down, left, right };
  char character = 0;  ///< "\n" for Enter; 0 for an arrow
  Arrow arrow = Arrow::none;
};

/// Error unavailable if the program was asked to stop, by Ctrl-C or SIGTERM.
Result<void> not_stopped();

/// The keys that a person presses in the terminal, without waiting for Enter. Ctrl-C is none of
/// them: see not_stopped(). Without a terminal there are none. One object at a time.
class Keys {
 public:
  Keys();
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;
  ~Keys() { restore(); }

  /// Gives the terminal back as it was; there are no keys afterwards.
  void restore();

  /// True if there is a person to press keys.
  bool has_person() const { return before_.has_value(); }
  /// The next key that was pressed; empty if none was. Does not wait.
  std::optional<Key> pressed();

 private:
  std::optional<char> next_byte();

  std::optional<termios> before_;  ///< the terminal's state; empty without a terminal
};

}  // namespace handcast::calibrate
