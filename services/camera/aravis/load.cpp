// SPDX-License-Identifier: Apache-2.0
// The part of this driver in handcast-camera: loads aravis.so, the rest of it.
#include "services/camera/camera.hpp"

namespace handcast::camera {

static Result<CameraBackend> load_aravis() {
  const auto row = service::load_row<CameraBackend>("camera", "aravis");
  if (!row) return tl::make_unexpected(row.error());
  if (*row) return **row;
  return fail(Errc::bad_config,
              "aravis.so is not installed in lib/handcast/camera; Debian's package of it is "
              "handcast-aravis");
}

Result<std::unique_ptr<Camera>> open_aravis(const Opening& with) {
  return load_aravis().and_then([&](const CameraBackend& row) { return row.open(with); });
}

Result<void> check_aravis(const Opening&) {
  return load_aravis().map([](const CameraBackend&) {});
}

}  // namespace handcast::camera
