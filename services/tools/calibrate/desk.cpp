// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/desk.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cmath>

#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"

namespace handcast::calibrate {
namespace {

constexpr std::int64_t kRefreshEvery_ns = 200'000'000, kLogEvery_ns = 5'000'000'000;

int percent_of(double share) { return static_cast<int>(std::lround(100 * share)); }

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

Result<bool> Keys::confirm(const char* question) {
  if (!has_person()) return true;
  fmt::print(stderr, "  {}\n", question);
  for (;; sleep_until_ns(now_ns() + 20'000'000)) {
    if (auto on = not_stopped(); !on) return tl::make_unexpected(on.error());
    const auto key = pressed();
    if (key && key->character == '\n') return true;
    if (key && key->character == 's') return false;
  }
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

Progress::Progress(Desk& desk, std::string title)
    : desk_(desk),
      title_(std::move(title)),
      end_(Deadline::at_ns(now_ns() + seconds_to_ns(desk.options.most_s))),
      is_terminal_(inherited::is_terminal(STDERR_FILENO)) {}

Progress::~Progress() {
  if (is_terminal_) fmt::print(stderr, "\n");
}

void Progress::show(double share, const std::string& advice) {
  desk_.screen.show_text({fmt::format("{}  {} %", title_, percent_of(share)), advice});
  say(share, advice);
}

void Progress::say(double share, const std::string& advice) {
  if (now_ns() - printed_ns_ < (is_terminal_ ? kRefreshEvery_ns : kLogEvery_ns)) return;
  printed_ns_ = now_ns();
  // \033[K clears the rest of the line (ECMA-48).
  fmt::print(stderr, "{}  {}: {:3} %  {}{}", is_terminal_ ? "\r" : "", title_, percent_of(share),
             printable(advice), is_terminal_ ? "\033[K" : "\n");
}

void Progress::note(const std::string& sentence) {
  fmt::print(stderr, "{}  - {}\n", is_terminal_ ? "\r\033[K" : "", printable(sentence));
  printed_ns_ = 0;
}

bool Progress::goes_on() {
  if (result_) result_ = desk_.own_rig.check();
  bool is_ended = !result_ || end_.passed();
  while (const auto key = desk_.keys.pressed()) is_ended = is_ended || key->character == '\n';
  return !is_ended;
}

}  // namespace handcast::calibrate
