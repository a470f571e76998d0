// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/camera/v4l2/device.hpp"
#include "services/camera/v4l2/format.hpp"
#include "services/camera/v4l2/sizes.hpp"

namespace handcast::camera::v4l2 {

/// What a camera delivers.
struct Mode {
  Layout layout;
  double rate_hz = 0;  ///< what the driver says that it holds; 0 if it does not say
};

/// Sets format, size and rate. `format`: automatic chooses the first of kFormats that the camera
/// has in this size. A camera that has no such rate holds another one (Mode::rate_hz). Errors:
/// bad_config, with the formats and sizes that the camera has (it lacks format or size, or sends
/// half-images), unavailable (in use), disconnected.
Result<Mode> set_mode(const Device& device, config::WebcamFormat format, Size size, double rate_hz);

}  // namespace handcast::camera::v4l2
