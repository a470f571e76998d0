// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/inherited.hpp"

namespace handcast::supervisor {
namespace {

// Alternate screen, no cursor, no wrapping at the right edge; and the reverse.
constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l\x1b[?7l";
constexpr std::string_view kLeave = "\x1b[?7h\x1b[?25h\x1b[?1049l";
constexpr std::string_view kBeginPicture = "\x1b[?2026h\x1b[H", kEndPicture = "\x1b[J\x1b[?2026l";

// Used by the signal handlers.
termios before{};
int signal_pipe = -1;

void put(std::string_view text) {
  while (!text.empty()) {
    const auto written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
    if (written < 0 && errno != EINTR) return;
  }
}

void give_back() {
  put(kLeave);
  tcsetattr(STDIN_FILENO, TCSANOW, &before);
}

void note(int number) {
  const auto byte = static_cast<char>(number);
  [[maybe_unused]] const auto written = ::write(signal_pipe, &byte, 1);
}

void crash(int number) {
  give_back();
  raise(number);  // SA_RESETHAND has removed this handler: the default action follows
}

void handle(int number, void (*handler)(int), unsigned flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(flags);
  sigaction(number, &action, nullptr);
}

bool asks_to_quit(std::string_view signals) {
  return std::ranges::any_of(signals, [](char number) { return number != SIGWINCH; });
}

std::string read_some(int fd) {
  std::array<char, 256> bytes;
  const auto count = ::read(fd, bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count))};
}

}  // namespace

std::vector<Key> keys_in(std::string_view bytes) {
  constexpr std::array<std::pair<std::string_view, Key>, 12> kKeys{{{"\x1b[A", Key::up},
                                                                    {"\x1bOA", Key::up},
                                                                    {"k", Key::up},
                                                                    {"\x1b[B", Key::down},
                                                                    {"\x1bOB", Key::down},
                                                                    {"j", Key::down},
                                                                    {"\x1b[5~", Key::page_up},
                                                                    {"\x1b[6~", Key::page_down},
                                                                    {" ", Key::page_down},
                                                                    {"m", Key::marks},
                                                                    {"q", Key::quit},
                                                                    {"Q", Key::quit}}};
  std::vector<Key> keys;
  while (!bytes.empty()) {
    const auto found =
        std::ranges::find_if(kKeys, [&](const auto& key) { return bytes.starts_with(key.first); });
    if (found != kKeys.end()) keys.push_back(found->second);
    bytes.remove_prefix(found != kKeys.end() ? found->first.size() : 1);
  }
  return keys;
}

bool Terminal::present() {
  return isatty(STDIN_FILENO) == 1 && inherited::is_terminal(STDOUT_FILENO);
}

Terminal::Terminal() {
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) ends = {-1, -1};
  signals_ = UniqueFd(ends[0]);
  signal_pipe = ends[1];

  tcgetattr(STDIN_FILENO, &before);
  auto raw = before;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_iflag &= ~static_cast<tcflag_t>(IXON);
  raw.c_cc[VSUSP] = _POSIX_VDISABLE;
  raw.c_cc[VQUIT] = _POSIX_VDISABLE;
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGWINCH}) handle(number, note, 0);
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    handle(number, crash, SA_RESETHAND | SA_NODEFER);
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  put(kEnter);
}

Terminal::~Terminal() {
  for (const int number :
       {SIGINT, SIGTERM, SIGHUP, SIGWINCH, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    handle(number, SIG_DFL, 0);
  give_back();
  ::close(std::exchange(signal_pipe, -1));
}

Terminal::Size Terminal::size() const {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
    return {};
  return {size.ws_col, size.ws_row};
}

void Terminal::show(const std::vector<std::string>& lines) const {
  std::string picture(kBeginPicture);
  for (const auto& line : lines)
    picture += (&line == &lines.front() ? "" : "\r\n") + line + "\x1b[K";
  put(picture.append(kEndPicture));
}

std::optional<std::vector<Key>> Terminal::wait(std::int64_t until_ns) const {
  const auto left_ms = std::max<std::int64_t>(0, (until_ns - now_ns() + 999'999) / 1'000'000);
  std::array<pollfd, 2> sources{
      {{.fd = STDIN_FILENO, .events = POLLIN}, {.fd = signals_.get(), .events = POLLIN}}};
  const int ready = poll(sources.data(), sources.size(), static_cast<int>(left_ms));
  if (ready == 0) return std::nullopt;
  if (ready < 0) return std::vector<Key>{};  // interrupted by a signal, which the next call reads
  if (sources[1].revents != 0 && asks_to_quit(read_some(signals_.get())))
    return std::vector{Key::quit};
  if (sources[0].revents == 0) return std::vector<Key>{};
  const auto bytes = read_some(STDIN_FILENO);
  return bytes.empty() ? std::vector{Key::quit} : keys_in(bytes);
}

}  // namespace handcast::supervisor
