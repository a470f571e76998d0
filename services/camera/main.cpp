// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "config/second_view.hpp"
#include "ipc/msg/largest_images.hpp"
#include "services/camera/camera.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/second_view.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

#ifdef HANDCAST_SECOND_VIEW
constexpr bool kIsSecondView = true;  ///< this program is handcast-camera2
#else
constexpr bool kIsSecondView = false;
#endif

using Frames = ipc::Writer<msg::CameraFrame>;
using Slot = ipc::Loan<msg::CameraFrame>;

/// Captures into the slot of camera.frames, and of a stereo camera into that of camera2.frames,
/// which is empty if readers hold all slots of that ring: the other eye's image is left out then.
static Result<void> capture(camera::Camera& source, Slot& slot, std::optional<Slot>& second,
                            const calib::Calibration& calibration) {
  slot->origin_error_ns = 0;
  slot->lost = {};
  const auto deadline = Deadline::in(50ms);
  const bool takes_both = second && *second;
  auto captured = takes_both ? source.capture_both(*slot, **second, slot.tail_bytes(), deadline)
                             : source.capture(*slot, slot.tail_bytes(), deadline);
  slot->calibration = calibration.id;
  if (takes_both) (*second)->calibration = calibration.camera2 ? calibration.id : 0;
  return captured;
}

/// Errors: bad_config (a second camera publishes to the ring of the other eye's images).
static Result<void> check_other_eye(const config::Rig& rig) {
  if (rig.camera2.backend == "none") return {};
  return fail(Errc::bad_config,
              "camera: it delivers the images of two cameras; set camera2.backend = \"none\" "
              "instead of \"" +
                  rig.camera2.backend + "\"");
}

/// The ring of the other eye's images; empty if the camera has none. Errors: those of
/// check_other_eye() and of the ring.
static Result<std::optional<Frames>> second_frames_of(const camera::Camera& source,
                                                      service::Context& context) {
  if (kIsSecondView || !source.has_second_image()) return std::nullopt;
  if (auto is_free = check_other_eye(context.rig()); !is_free)
    return tl::make_unexpected(is_free.error());
  return context.writer<msg::CameraFrame>("camera2.frames").map([](Frames&& frames) {
    return std::optional(std::move(frames));
  });
}

/// Publishes the images of the camera to the ring camera.frames, and those of the other eye of a
/// stereo camera to camera2.frames.
static void run_camera(service::Context& context) {
  if (service::is_exclusive(context.rig().camera.backend, camera::camera_backends()))
    context.stand_by();
  const auto source =
      must(camera::open_camera(context.rig(), context.calibration(), context.epoch_ns()));
  context.stand_by();
  auto frames = must(context.writer<msg::CameraFrame>("camera.frames"));
  auto second_frames = must(second_frames_of(*source, context));

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
    std::optional<Slot> second;
    if (second_frames) second.emplace(second_frames->loan());
    if (const auto captured = capture(*source, slot, second, context.calibration()); !captured) {
      context.tolerate(captured.error());
      continue;
    }
    const msg::Header header = slot->header;
    const msg::FrameLosses lost = slot->lost;
    frames.publish(std::move(slot));
    if (second && *second) second_frames->publish(std::move(*second));
    context.mark(header, std::array{msg::StageMark{msg::Stage::capture, msg::detail_of(lost),
                                                   header.origin_ns, now_ns()}});
  }
}

static Result<void> check_camera(const config::Rig& rig, const calib::Calibration& calibration) {
  constexpr std::size_t kRoom = msg::kLargestCameraWidth_px * msg::kLargestCameraHeight_px;
  const auto& camera = calibration.camera;
  if (auto fits = camera::check_room(camera.width_px, camera.height_px, kRoom); !fits) return fits;
  if (!kIsSecondView && config::has_two_eyes(rig.camera))
    if (auto is_free = check_other_eye(rig); !is_free) return is_free;
  return service::check_backend("camera", rig.camera.backend, camera::camera_backends(), rig,
                                calibration, now_ns());
}

static daemon::ServiceDescription description() {
  daemon::ServiceDescription first{.name = "camera",
                                   .summary = "Delivers the frames of the infrared camera.",
                                   .paced_by = "its device",
                                   .publishes = {"camera.frames"},
                                   .subscribes = {"projection.frames"},
                                   .settings = {"camera.rate_hz", "camera.exposure_ms"},
                                   .backends = service::describe_rows(camera::camera_backends())};
  if (kIsSecondView) return service::of_second_view(std::move(first));
  first.publishes.emplace_back("camera2.frames");
  return first;
}

int main(int argc, char** argv) {
  return service::run(description(), argc, argv, run_camera, check_camera);
}
