// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::desk {

/// Counts what was wrong with what came in, and names it in the log at most once a second. One
/// thread; count(): any thread.
class Complaints {
 public:
  /// Takes a finished line.
  using Say = std::function<void(const std::string& line)>;

  /// `where`: the start of the lines, e.g. "osc".
  explicit Complaints(
      std::string where,
      Say say = [](const std::string& line) { log::write(log::Level::warning, line); })
      : where_(std::move(where)), say_(std::move(say)) {}

  /// Counts a fault at `now_ns` (CLOCK_MONOTONIC).
  void add(std::int64_t now_ns, std::string_view sentence) {
    count_.fetch_add(1, std::memory_order_relaxed);  // a number for people, nothing depends on it
    if (said_ns_ != 0 && now_ns - said_ns_ < kPause_ns) {
      ++unsaid_;
      return;
    }
    const auto others = std::exchange(unsaid_, 0);
    said_ns_ = now_ns;
    say_(printable(others ? fmt::format("{}: {} ({} other faults since the last such line)", where_,
                                        sentence, others)
                          : fmt::format("{}: {}", where_, sentence)));
  }
  /// All faults so far.
  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kPause_ns = 1'000'000'000;

  std::string where_;
  Say say_;
  std::atomic<std::uint64_t> count_ = 0;
  std::uint64_t unsaid_ = 0;
  std::int64_t said_ns_ = 0;
};

}  // namespace handcast::desk
