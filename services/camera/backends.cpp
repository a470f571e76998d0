// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "config/sections/twin/world_settings.hpp"
#include "services/camera/camera.hpp"

namespace handcast::camera {

#ifdef HANDCAST_WITH_ARAVIS
Result<std::unique_ptr<Camera>> open_aravis(const Opening&);
Result<void> check_aravis(const Opening&);
#endif
#ifdef HANDCAST_WITH_LIBUSB
Result<std::unique_ptr<Camera>> open_leap(const Opening&);
Result<void> check_leap(const Opening&);
#endif
Result<std::unique_ptr<Camera>> open_twin(const Opening&);
Result<std::unique_ptr<Camera>> open_replay(const Opening&);
Result<std::unique_ptr<Camera>> open_external(const Opening&);
Result<std::unique_ptr<Camera>> open_v4l2(const Opening&);

static constexpr std::array kBackends{
#ifdef HANDCAST_WITH_ARAVIS
    CameraBackend{.name = "aravis",
                  .sentence = "A GigE Vision or USB3 Vision camera.",
                  .open = open_aravis,
                  .reads = {"camera.aravis", "camera.delivery_ms"},
                  .exclusive = true,
                  .check = check_aravis},
#endif
    CameraBackend{.name = "twin",
                  .sentence = "Draws the twin's hand as an infrared camera would see it.",
                  .open = open_twin,
                  .reads = config::kTwinWorldSettings + config::SettingList{"twin.image"}},
    CameraBackend{.name = "replay",
                  .sentence =
                      "Plays a recording of `handcast record`, PNG images, a film or a .npy "
                      "array.",
                  .open = open_replay,
                  .reads = {"camera.replay"}},
    CameraBackend{.name = "external",
                  .sentence = "A program of your own, in any language, by handcast.h.",
                  .open = open_external,
                  .check = service::kSeenWhenUp},
    CameraBackend{.name = "v4l2",
                  .sentence = "A webcam, by the kernel's own interface (Video4Linux).",
                  .open = open_v4l2,
                  .reads = {"camera.v4l2", "camera.delivery_ms"},
                  .exclusive = true},
#ifdef HANDCAST_WITH_LIBUSB
    CameraBackend{.name = "leap",
                  .sentence = "A Leap Motion Controller as a stereo camera, over USB without its "
                              "maker's software.",
                  .open = open_leap,
                  .reads = {"camera.leap", "camera.delivery_ms"},
                  .exclusive = true,
                  .check = check_leap},
#endif
};

std::span<const CameraBackend> camera_backends() { return kBackends; }

Result<Opening> opening_of(const config::Rig& rig, const calib::Calibration& calibration,
                           std::int64_t epoch_ns, config::Viewpoint at) {
  auto camera = calib::camera_at(calibration, at);
  if (!camera) return tl::make_unexpected(camera.error());
  return Opening{rig, calibration, epoch_ns, at, config::camera_at(rig, at), std::move(*camera)};
}

Result<std::unique_ptr<Camera>> open_camera(const config::Rig& rig,
                                            const calib::Calibration& calibration,
                                            std::int64_t epoch_ns, config::Viewpoint at,
                                            const ipc::OpenRing& ring) {
  auto with = opening_of(rig, calibration, epoch_ns, at);
  if (!with) return tl::make_unexpected(with.error());
  with->ring = ring;
  const auto name = config::name_at(at, "camera");
  const auto row = service::find_backend(name, with->settings.backend, camera_backends());
  if (!row) return tl::make_unexpected(row.error());
  return service::in_backend(name, row->name, row->open(*with));
}

Result<void> check_camera(const config::Rig& rig, const calib::Calibration& calibration,
                          config::Viewpoint at) {
  const auto with = opening_of(rig, calibration, now_ns(), at);
  if (!with) return tl::make_unexpected(with.error());
  const auto name = config::name_at(at, "camera");
  const auto row = service::find_backend(name, with->settings.backend, camera_backends());
  if (!row) return tl::make_unexpected(row.error());
  return service::in_backend(name, row->name, row->examine(*with));
}

}  // namespace handcast::camera
