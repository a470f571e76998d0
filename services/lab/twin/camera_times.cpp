// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/camera_times.hpp"

#include "ipc/base/clock.hpp"

namespace handcast::twin {

CameraTimes::CameraTimes(const config::Camera& camera, const config::Twin& twin)
    : rate_hz_(camera.rate_hz),
      lost_(twin.image.lost),
      burst_(twin.image.burst),
      transfer_ns_(ms_to_ns(camera.exposure_ms) / 2 + ms_to_ns(twin.image.delivery_ms)),
      loss_(twin.seed, Stream::camera_loss),
      bursts_(twin.seed, Stream::camera_burst),
      clock_(twin.image.clock, 0, seconds_to_ns(1 / camera.rate_hz),
             Random(twin.seed, Stream::camera_clock)) {}

std::int64_t CameraTimes::origin_ns(std::uint64_t k) const {
  return seconds_to_ns(static_cast<double>(k) / rate_hz_);
}

std::int64_t CameraTimes::arrival_ns(std::uint64_t k) const {
  return burst_arrival_ns(k, burst_, bursts_,
                          [this](std::uint64_t i) { return origin_ns(i) + transfer_ns_; });
}

bool CameraTimes::lost(std::uint64_t k) const { return loss_.uniform(k) < lost_; }

}  // namespace handcast::twin
