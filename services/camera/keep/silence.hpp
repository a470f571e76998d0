// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "ipc/base/clock.hpp"

namespace handcast::camera {

/// Tells when a camera has sent nothing for too long. One thread.
class Silence {
 public:
  /// How often a keeper looks.
  static constexpr std::int64_t kTurn_ns = 5'000'000;

  /// Three periods, but at least 50 ms.
  static std::int64_t patience_of(double rate_hz) {
    return std::max(std::int64_t{50'000'000}, seconds_to_ns(3 / rate_hz));
  }

  /// Begins now. `patience_ns`: how long no image is no reason to open the camera again.
  explicit Silence(std::int64_t patience_ns) : patience_ns_(patience_ns) {}

  /// The camera was opened again.
  void begin_again() { begun_ns_ = now_ns(); }
  /// Whether an image has come since then. `last_ns`: when the last one came.
  bool is_broken(std::int64_t last_ns) const { return last_ns > begun_ns_; }
  /// Whether it has lasted too long at `time_ns`. The first image may take a second.
  bool is_too_long(std::int64_t last_ns, std::int64_t time_ns) const {
    return time_ns > (is_broken(last_ns) ? last_ns + patience_ns_ : begun_ns_ + kFirstImage_ns);
  }

 private:
  static constexpr std::int64_t kFirstImage_ns = 1'000'000'000;

  std::int64_t patience_ns_, begun_ns_ = now_ns();
};

}  // namespace handcast::camera
