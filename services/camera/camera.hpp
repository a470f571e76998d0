// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <span>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/ring/reader.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::camera {

/// A camera that delivers grey images of the size in the calibration. One thread.
class Camera {
 public:
  virtual ~Camera() = default;

  /// Fills `frame` and the `tail_bytes` behind it with the next image; waits for it until the
  /// deadline. Frame ids and origins increase from call to call; images that were not fetched in
  /// time are skipped, not queued. Errors: timeout, bad_data (this image is lost), disconnected,
  /// bad_config (the image does not fit the tail).
  virtual Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                               Deadline deadline) = 0;

  /// True for a stereo camera: each image comes with one of its other eye, which capture_both()
  /// gives to its service and capture() drops.
  virtual bool has_second_image() const { return false; }
  /// As capture(); `second` has as much room and gets the other image, with the same frame id,
  /// origin and losses. Only with has_second_image().
  virtual Result<void> capture_both(msg::CameraFrame& frame, msg::CameraFrame& /*second*/,
                                    std::size_t tail_bytes, Deadline deadline) {
    return capture(frame, tail_bytes, deadline);
  }

  /// True for a camera of the twin in front of which the rig's own light falls. Its service gives
  /// it the projections before the first capture().
  virtual bool sees_light() const { return false; }
  /// Takes the reader of projection.frames.
  virtual void watch_light(ipc::Reader<msg::Projection> /*projections*/) {}
};

/// A back end, opened with the rig, its calibration, and the epoch of the rig (CLOCK_MONOTONIC,
/// ns).
using CameraBackend = service::Backend<Camera, config::Rig, calib::Calibration, std::int64_t>;

/// All back ends of this build.
std::span<const CameraBackend> camera_backends();

/// Opens the back end rig.camera.backend. Errors: bad_config (unknown back end, or its settings are
/// wrong), and those of the back end.
Result<std::unique_ptr<Camera>> open_camera(const config::Rig& rig,
                                            const calib::Calibration& calibration,
                                            std::int64_t epoch_ns);

/// Checks that an image fits into the tail of its message. Errors: bad_config (it does not).
inline Result<void> check_room(int width_px, int height_px, std::size_t tail_bytes) {
  const std::size_t needed = static_cast<std::size_t>(width_px) * height_px;
  if (needed <= tail_bytes) return {};
  return fail(
      Errc::bad_config,
      fmt::format("camera: an image of {} x {} px does not fit the {} bytes of its ring's slots",
                  width_px, height_px, tail_bytes));
}

}  // namespace handcast::camera
