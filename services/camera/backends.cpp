// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "config/sections/twin/world_settings.hpp"
#include "services/camera/camera.hpp"

namespace handcast::camera {

#ifdef HANDCAST_WITH_ARAVIS
Result<std::unique_ptr<Camera>> open_aravis(const config::Rig&, const calib::Calibration&,
                                            const std::int64_t& epoch_ns);
#endif
#ifdef HANDCAST_WITH_LIBUSB
Result<std::unique_ptr<Camera>> open_leap(const config::Rig&, const calib::Calibration&,
                                          const std::int64_t& epoch_ns);
Result<void> check_leap(const config::Rig&, const calib::Calibration&,
                        const std::int64_t& epoch_ns);
#endif
Result<std::unique_ptr<Camera>> open_twin(const config::Rig&, const calib::Calibration&,
                                          const std::int64_t& epoch_ns);
Result<std::unique_ptr<Camera>> open_replay(const config::Rig&, const calib::Calibration&,
                                            const std::int64_t& epoch_ns);
Result<std::unique_ptr<Camera>> open_v4l2(const config::Rig&, const calib::Calibration&,
                                          const std::int64_t& epoch_ns);

static constexpr std::array kBackends{
#ifdef HANDCAST_WITH_ARAVIS
    CameraBackend{.name = "aravis",
                  .sentence = "A GigE Vision or USB3 Vision camera.",
                  .open = open_aravis,
                  .reads = {"camera.aravis", "camera.delivery_ms"},
                  .exclusive = true},
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

Result<std::unique_ptr<Camera>> open_camera(const config::Rig& rig,
                                            const calib::Calibration& calibration,
                                            std::int64_t epoch_ns) {
  return service::open_backend("camera", rig.camera.backend, camera_backends(), rig, calibration,
                               epoch_ns);
}

}  // namespace handcast::camera
