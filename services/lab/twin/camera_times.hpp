// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "config/rig.hpp"
#include "services/lab/twin/random.hpp"
#include "services/lab/twin/sensor_clock.hpp"

namespace handcast::twin {

/// The times of the twin's camera: what is true, and what its stamps say. Pure functions of the
/// settings, the seed and the number of the frame. Times are ns since the rig's epoch.
class CameraTimes {
 public:
  /// Copies what it needs.
  CameraTimes(const config::Camera& camera, const config::Twin& twin);

  /// The true middle of the exposure of frame `k`.
  std::int64_t origin_ns(std::uint64_t k) const;
  /// The middle of its exposure by the camera's clock: the only time that the cascade sees.
  std::int64_t stamp_ns(std::uint64_t k) const { return clock_.stamp_ns(k, origin_ns(k)); }
  /// The time at which frame `k` is in memory. Does not decrease with k.
  std::int64_t arrival_ns(std::uint64_t k) const;
  /// True if frame `k` never arrives.
  bool lost(std::uint64_t k) const;
  /// The true time of the image of this id and stamp. An image that is not this camera's is taken
  /// at its stamp.
  std::int64_t true_ns(std::uint64_t frame_id, std::int64_t stamp) const {
    return stamp == stamp_ns(frame_id) ? origin_ns(frame_id) : stamp;
  }

 private:
  double rate_hz_, lost_, burst_;
  std::int64_t transfer_ns_;  ///< from the middle of an exposure to the image in memory
  Random loss_, bursts_;
  SensorClock clock_;
};

}  // namespace handcast::twin
