// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/keys.hpp"

#include <poll.h>
#include <unistd.h>

#include "ipc/daemon/stop_signal.hpp"

namespace handcast::calibrate {
namespace {

constexpr char kEscape = '\x1b';

Key::Arrow arrow_of(char code) {
  switch (code) {
    case 'A':
      return Key::Arrow::up;
    case 'B':
      return Key::Arrow::down;
    case 'C':
      return Key::Arrow::right;
    case 'D':
      return Key::Arrow::left;
    default:
      return Key::Arrow::none;
  }
}

}  // namespace

Result<void> not_stopped() {
  if (!daemon::stop_requested()) return {};
  return fail(Errc::unavailable, "stopped; the next call goes on with this step");
}

Keys::Keys() {
  termios state{};
  if (isatty(STDIN_FILENO) != 1 || tcgetattr(STDIN_FILENO, &state) != 0) return;
  before_ = state;
  state.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &state);
}

void Keys::restore() {
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
  before_.reset();
}

std::optional<char> Keys::next_byte() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char byte = 0;
  if (::poll(&input, 1, 0) != 1 || ::read(STDIN_FILENO, &byte, 1) != 1) return std::nullopt;
  return byte;
}

/// Arrows are three bytes: Escape, [ or O, and a letter (ECMA-48).
std::optional<Key> Keys::pressed() {
  if (!has_person()) return std::nullopt;
  const auto first = next_byte();
  if (!first) return std::nullopt;
  if (*first != kEscape) return Key{*first == '\r' ? '\n' : *first};
  const auto second = next_byte();
  if (!second) return Key{kEscape};
  const auto third = next_byte();
  return third ? Key{0, arrow_of(*third)} : Key{kEscape};
}

}  // namespace handcast::calibrate
