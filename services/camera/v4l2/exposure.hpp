// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "services/camera/v4l2/device.hpp"

namespace handcast::camera::v4l2 {

/// How long a camera exposes its images.
struct Exposure {
  std::int64_t time_ns = 0;
  /// Half the width of the interval in which time_ns lies: half a unit of the control, or time_ns
  /// if the camera does not say.
  std::int64_t error_ns = 0;
};

/// Asks for exposures of `exposure_ms` that the camera does not change by itself. A camera that
/// lacks the controls is left as it is, with a line in the log. Errors: bad_config (the camera
/// cannot expose that long or short; with its range), unavailable, disconnected.
Result<void> set_exposure(const Device& device, double exposure_ms);

/// The exposure that the device holds: `exposure_ms` if it does not say, or chooses it itself.
Exposure held_exposure(int fd, double exposure_ms);

}  // namespace handcast::camera::v4l2
