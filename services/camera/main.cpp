// SPDX-License-Identifier: Apache-2.0
#include "ipc/msg/largest_images.hpp"
#include "services/camera/camera.hpp"
#include "services/camera/frame_size.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// Publishes the images of the camera to the ring camera.frames.
static void run_camera(service::Context& context) {
  if (service::is_exclusive(context.rig().camera.backend, camera::camera_backends()))
    context.stand_by();
  const auto source =
      must(camera::open_camera(context.rig(), context.calibration(), context.epoch_ns()));
  context.stand_by();
  auto frames = must(context.writer<msg::CameraFrame>("camera.frames"));

  if (source->sees_light())
    source->watch_light(must(context.reader<msg::Projection>("projection.frames")));

  context.ready();
  while (context.running()) {
    auto slot = frames.loan();
    if (!slot) {
      context.tolerate({Errc::timeout, "camera: all slots of camera.frames are held by readers"});
      sleep_until_ns(now_ns() + to_ns(1ms));
      continue;
    }
    slot->origin_error_ns = 0;
    slot->lost = {};
    if (const auto captured = source->capture(*slot, slot.tail_bytes(), Deadline::in(50ms));
        !captured) {
      context.tolerate(captured.error());
      continue;
    }
    slot->calibration = context.calibration().id;
    const msg::Header header = slot->header;
    const msg::FrameLosses lost = slot->lost;
    frames.publish(std::move(slot));
    context.mark(header, std::array{msg::StageMark{msg::Stage::capture, msg::detail_of(lost),
                                                   header.origin_ns, now_ns()}});
  }
}

static Result<void> check_camera(const config::Rig& rig, const calib::Calibration& calibration) {
  constexpr std::size_t kRoom = msg::kLargestCameraWidth_px * msg::kLargestCameraHeight_px;
  const auto& camera = calibration.camera;
  if (auto fits = camera::check_room(camera.width_px, camera.height_px, kRoom); !fits) return fits;
  return service::check_backend("camera", rig.camera.backend, camera::camera_backends(), rig,
                                calibration, now_ns());
}

int main(int argc, char** argv) {
  return service::run({.name = "camera",
                       .summary = "Delivers the frames of the infrared camera.",
                       .paced_by = "its device",
                       .publishes = {"camera.frames"},
                       .subscribes = {"projection.frames"},
                       .settings = {"camera.rate_hz", "camera.exposure_ms"},
                       .backends = service::describe_rows(camera::camera_backends())},
                      argc, argv, run_camera, check_camera);
}
