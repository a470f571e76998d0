// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "calib/clock_map.hpp"
#include "services/pose/leapc/declarations.hpp"

namespace handcast::pose::leapc {

/// Maps the time stamps of Ultraleap's service to CLOCK_MONOTONIC with the library's clock rebaser.
/// A stamp that it maps to a time after the arrival, or to one that is long past, cannot be of the
/// service's clock; it is mapped by the lower envelope of the arrivals instead. One thread.
class HostClock {
 public:
  /// `least_age_ns`: of a sample when it arrives, for the lower envelope. `call` must outlive it.
  HostClock(const Functions& call, std::int64_t least_age_ns);
  HostClock(const HostClock&) = delete;
  HostClock& operator=(const HostClock&) = delete;
  ~HostClock();

  /// The time of a stamp that arrived at `arrival_ns`, CLOCK_MONOTONIC. Call it at the arrival.
  std::int64_t origin_ns(std::int64_t stamp_us, std::int64_t arrival_ns);

  /// True if the last stamp was mapped by its arrival.
  bool is_guessed() const { return is_guessed_; }

 private:
  std::int64_t rebased_age_ns(std::int64_t stamp_us, std::int64_t arrival_ns);

  const Functions& call_;
  std::int64_t least_age_ns_;
  RebaserHandle rebaser_ = nullptr;
  std::int64_t updated_ns_ = 0;
  calib::ClockMap arrivals_;
  bool is_guessed_ = false;
};

}  // namespace handcast::pose::leapc
