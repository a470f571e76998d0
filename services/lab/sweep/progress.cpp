// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"

namespace handcast::sweep {
namespace {

constexpr const char* kClearLine = "\r\033[K";
constexpr std::int64_t kPause_ns = 100'000'000;  ///< least time between updates of the terminal

std::string print_span(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

Progress::Progress(std::string plan, std::size_t runs, bool quiet)
    : plan_(std::move(plan)),
      runs_(runs),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO)),
      start_ns_(now_ns()) {}

Progress::~Progress() {
  if (terminal_ && !quiet_ && done_ > 0) log::put("\n");
}

void Progress::one_done(bool failed) {
  const std::lock_guard lock(mutex_);
  ++done_;
  failed_ += failed;
  const auto tenths = 10 * done_ / runs_;
  const bool due =
      terminal_ ? now_ns() >= shown_ns_ + kPause_ns || done_ == runs_ : tenths > tenths_;
  tenths_ = tenths;
  if (due && !quiet_) show();
}

void Progress::say(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  log::put(fmt::format("{}{}\n", terminal_ ? kClearLine : "", sentence));
}

void Progress::show() {
  shown_ns_ = now_ns();
  const auto elapsed_s = ns_to_seconds(shown_ns_ - start_ns_);
  const auto rate_hz = static_cast<double>(done_) / elapsed_s;
  log::put(fmt::format("{}sweep {}: {} of {} runs, {} %{}, {:.3g} runs a second, about {} left{}",
                       terminal_ ? kClearLine : "", plan_, done_, runs_, 100 * done_ / runs_,
                       failed_ ? fmt::format(", {} failed", failed_) : "", rate_hz,
                       print_span(static_cast<double>(runs_ - done_) / rate_hz),
                       terminal_ ? "" : "\n"));
}

}  // namespace handcast::sweep
