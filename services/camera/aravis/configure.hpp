// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/sensors.hpp"
#include "services/camera/aravis/glib.hpp"

namespace handcast::camera::aravis {

/// What a camera has accepted.
struct Accepted {
  double rate_hz = 0;      ///< of free-running images
  double exposure_ms = 0;  ///< in the steps of the camera
  int packet_bytes = 0;    ///< 0 if it has no packets
};

/// Sets up a camera for images of the given size. Errors: bad_config (it refuses a setting; the
/// sentence names the setting and the camera's own range), unavailable (it does not answer).
Result<Accepted> configure(ArvCamera* camera, const config::Camera& settings, int width_px,
                           int height_px);

}  // namespace handcast::camera::aravis
