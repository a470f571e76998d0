// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace handcast::supervisor {

/// The deaths of the supervisors of one keeper.
class SupervisorDeaths {
 public:
  static constexpr int kDeathsInAMinute = 10;  ///< after which no supervisor is started again

  /// Adds a death. Times are CLOCK_MONOTONIC.
  void add(std::int64_t started_ns, std::int64_t died_ns) {
    recent_ns_[count_++ % recent_ns_.size()] = died_ns;
    short_lives_ = died_ns - started_ns < kShortLife_ns ? short_lives_ + 1 : 0;
  }
  /// True if there were kDeathsInAMinute within the last minute.
  bool too_many(std::int64_t now) const {
    return std::ranges::count_if(recent_ns_, [&](std::int64_t died_ns) {
             return died_ns > 0 && now - died_ns < kMinute_ns;
           }) == kDeathsInAMinute;
  }
  /// The wait before the next start; 0 unless at least two lives in a row were short.
  std::int64_t pause_ns() const {
    return short_lives_ < 2 ? 0 : kFirstPause_ns << (std::min(short_lives_, 6) - 2);
  }

 private:
  static constexpr std::int64_t kShortLife_ns = 1'000'000'000;  ///< a failed start is shorter
  static constexpr std::int64_t kFirstPause_ns = 50'000'000;
  static constexpr std::int64_t kMinute_ns = 60'000'000'000;

  std::array<std::int64_t, kDeathsInAMinute> recent_ns_{};
  std::size_t count_ = 0;
  int short_lives_ = 0;
};

}  // namespace handcast::supervisor
