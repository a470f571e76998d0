// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/desk.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

namespace handcast::calibrate {
namespace {

constexpr std::int64_t kPrintEvery_ns = 200'000'000, kLogEvery_ns = 5'000'000'000;

int percent_of(double share) { return static_cast<int>(std::lround(100 * share)); }

}  // namespace

Progress::Progress(Desk& desk, std::string title)
    : desk_(desk),
      title_(std::move(title)),
      end_(Deadline::at_ns(now_ns() + seconds_to_ns(desk.options.most_s))),
      is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (is_terminal_) fmt::print(stderr, "\n");
}

void Progress::show(double share, const std::string& advice) {
  desk_.screen.show_text({fmt::format("{}  {} %", title_, percent_of(share)), advice});
  say(share, advice);
}

void Progress::say(double share, const std::string& advice) {
  if (now_ns() - printed_ns_ < (is_terminal_ ? kPrintEvery_ns : kLogEvery_ns)) return;
  printed_ns_ = now_ns();
  // \033[K clears the rest of the line (ECMA-48).
  fmt::print(stderr, "{}  {}: {:3} %  {}{}", is_terminal_ ? "\r" : "", title_, percent_of(share),
             advice, is_terminal_ ? "\033[K" : "\n");
}

void Progress::note(const std::string& sentence) {
  fmt::print(stderr, "{}  - {}\n", is_terminal_ ? "\r\033[K" : "", sentence);
  printed_ns_ = 0;
}

Result<bool> Progress::goes_on() {
  if (auto runs = desk_.own_rig.check(); !runs) return tl::make_unexpected(runs.error());
  bool is_ended = end_.passed();
  while (const auto key = desk_.keys.pressed()) is_ended = is_ended || key->character == '\n';
  return !is_ended;
}

}  // namespace handcast::calibrate
