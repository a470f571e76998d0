// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>

#include "config/second_view.hpp"
#include "ipc/msg/largest_images.hpp"
#include "services/camera/camera.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using config::Viewpoint;
using service::must;

using Frames = ipc::Writer<msg::CameraFrame>;
using Slot = ipc::Loan<msg::CameraFrame>;

/// Captures into the slot of the service's ring, and of a stereo camera into that of
/// camera2.frames, which is empty if readers hold all slots of that ring: the other eye's image is
/// left out then.
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
                                                      service::Context& context, Viewpoint at) {
  if (at == Viewpoint::second || !source.has_second_image()) return std::nullopt;
  if (auto is_free = check_other_eye(context.rig()); !is_free)
    return tl::make_unexpected(is_free.error());
  return context.writer<msg::CameraFrame>("camera2.frames").map([](Frames&& frames) {
    return std::optional(std::move(frames));
  });
}

/// Publishes the images of the camera at a viewpoint to its ring, and those of the other eye of a
/// stereo camera to camera2.frames.
static void run_camera(service::Context& context, Viewpoint at) {
  const auto name = config::name_at(at, "camera"), ring = config::name_at(at, "camera.frames");
  const auto& backend = config::camera_at(context.rig(), at).backend;
  if (service::is_exclusive(name, backend, camera::camera_backends())) context.stand_by();
  const auto source =
      must(camera::open_camera(context.rig(), context.calibration(), context.epoch_ns(), at,
                               [&](std::string_view stream) { return context.ring(stream); }));
  context.stand_by();
  auto frames = must(context.writer<msg::CameraFrame>(ring));
  auto second_frames = must(second_frames_of(*source, context, at));

  if (source->sees_light())
    source->watch_light(must(context.reader<msg::Projection>("projection.frames")));

  const auto live = source->is_adjustable() ? must(context.live_settings()) : nullptr;
  context.ready();
  while (context.running()) {
    service::pass_on(live.get(), *source);
    auto slot = frames.loan();
    if (!slot) {
      context.tolerate({Errc::timeout, name + ": all slots of its ring are held by readers"});
      sleep_until_ns(now_ns() + to_ns(1ms));
      continue;
    }
    std::optional<Slot> second;
    if (second_frames) second.emplace(second_frames->loan());
    const auto captured =
        service::in_backend(name, backend, capture(*source, slot, second, context.calibration()));
    if (!captured) {
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

static Result<void> check(const config::Rig& rig, const calib::Calibration& calibration,
                          Viewpoint at) {
  constexpr std::size_t kRoom = msg::kLargestCameraWidth_px * msg::kLargestCameraHeight_px;
  const auto camera = calib::camera_at(calibration, at);
  if (!camera) return tl::make_unexpected(camera.error());
  const auto& model = camera->model;
  if (auto fits = camera::check_room(model.width_px, model.height_px, kRoom); !fits)
    return fail_in(config::name_at(at, "camera"), fits.error());
  if (at == Viewpoint::first && config::has_two_eyes(rig.camera))
    if (auto is_free = check_other_eye(rig); !is_free) return is_free;
  return camera::check_camera(rig, calibration, at);
}

static daemon::ServiceDescription describe(Viewpoint at) {
  daemon::ServiceDescription first{.name = "camera",
                                   .summary = "Delivers the frames of the infrared camera.",
                                   .paced_by = "its device",
                                   .publishes = {"camera.frames"},
                                   .subscribes = {"projection.frames"},
                                   .settings = {"camera.rate_hz", "camera.exposure_ms"},
                                   .backends = service::describe_rows(camera::camera_backends())};
  auto description = service::describe_at(at, std::move(first));
  description.subscribes.push_back("guest." + config::name_at(at, "camera"));
  if (at == Viewpoint::first) description.publishes.emplace_back("camera2.frames");
  return description;
}

static service::Instance instance_at(Viewpoint at) {
  return {describe(at), [at](service::Context& context) { run_camera(context, at); },
          [at](const config::Rig& rig, const calib::Calibration& calibration) {
            return check(rig, calibration, at);
          },
          [](const daemon::Search& search) {
            return service::attached_of_files<camera::CameraBackend>("camera", search);
          }};
}

int main(int argc, char** argv) {
  return service::run(std::array{instance_at(Viewpoint::first), instance_at(Viewpoint::second)},
                      argc, argv);
}
