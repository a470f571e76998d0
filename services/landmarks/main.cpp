// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>
#include <utility>

#include "ipc/base/log.hpp"
#include "ipc/msg/detector_note.hpp"
#include "ipc/msg/same_calibration.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using config::Viewpoint;
using service::must;

/// Takes all samples of the tracker that have arrived. A rig without a tracker has no such ring;
/// errors of the ring are reported once a second.
static void take_poses(service::Context& context, Result<ipc::Reader<msg::HandPoses>>& poses,
                       landmarks::TrackerHints& tracker) {
  if (!poses) return;
  auto sample = poses->next(Deadline::now());
  for (; sample; sample = poses->next(Deadline::now()))
    if (msg::check_calibration(**sample, context.calibration().id)) tracker.push(**sample);
  if (sample.error().code != Errc::timeout) context.tolerate(sample.error());
}

/// Publishes the landmarks of the newest frame of the camera at a viewpoint, back to back. Frames
/// that arrive during a detection are skipped.
static void run_landmarks(service::Context& context, Viewpoint at) {
  const auto choice = landmarks::choose_detector(context.rig(), at);
  const auto name = config::name_at(at, "landmarks");
  const msg::DetectorNote note{.is_fallback = !choice.why.empty()};
  if (!choice.why.empty()) log::warning("{}", choice.why);
  if (service::is_exclusive(name, choice.backend, landmarks::detector_backends()))
    context.stand_by();
  const auto detector =
      must(landmarks::open_detector(context.rig(), context.calibration(), context.epoch_ns(), at,
                                    [&](std::string_view stream) { return context.ring(stream); }));
  context.stand_by();
  auto frames = must(context.reader<msg::CameraFrame>(config::name_at(at, "camera.frames")));
  auto poses = context.reader<msg::HandPoses>("pose.hands");
  landmarks::TrackerHints tracker(must(calib::camera_at(context.calibration(), at)));
  auto hands = must(context.writer<msg::Landmarks>(config::name_at(at, "landmarks.hands")));

  const auto live = detector->is_adjustable() ? must(context.live_settings()) : nullptr;
  std::optional<ipc::Sample<msg::CameraFrame>> frame;  // the newest
  context.ready();
  while (context.running()) {
    service::pass_on(live.get(), *detector);
    if (detector->reads_images()) frame.reset();  // the camera needs its slot
    const bool is_needed = !frame;
    if (auto next = frames.latest(is_needed ? Deadline::in(50ms) : Deadline::now())) {
      frame.emplace(std::move(*next));
    } else if (is_needed) {
      context.tolerate(next.error());
      continue;
    }
    if (auto ours = msg::check_calibration(**frame, context.calibration().id); !ours) {
      context.tolerate(ours.error());
      continue;
    }
    const std::int64_t begin_ns = now_ns();
    take_poses(context, poses, tracker);
    const auto hints = tracker.at((*frame)->header.origin_ns);
    auto found = detector->detect(**frame, hints, Deadline::in(50ms));
    while (!found && found.error().code == Errc::timeout && context.running())
      found = detector->detect(**frame, hints, Deadline::in(50ms));
    found = service::in_backend(name, choice.backend, std::move(found));
    if (!found) {
      context.tolerate(found.error());
      continue;
    }
    found->calibration = (*frame)->calibration;
    hands.publish(*found);
    context.mark(found->header, std::array{msg::StageMark{msg::Stage::detect, msg::detail_of(note),
                                                          begin_ns, now_ns()}});
  }
}

static service::Instance instance_at(Viewpoint at) {
  auto description = service::describe_at(
      at, {.name = "landmarks",
           .summary = "Finds the landmarks of the hands in camera images.",
           .paced_by = "camera.frames",
           .publishes = {"landmarks.hands"},
           .subscribes = {"camera.frames", "pose.hands"},
           .settings = {"landmarks.fallback"},
           .backends = service::describe_rows(landmarks::detector_backends())});
  description.subscribes.push_back("guest." + config::name_at(at, "landmarks"));
  return {std::move(description), [at](service::Context& context) { run_landmarks(context, at); },
          [at](const config::Rig& rig, const calib::Calibration& calibration) {
            return landmarks::check_detector(rig, calibration, at);
          }};
}

int main(int argc, char** argv) {
  return service::run(std::array{instance_at(Viewpoint::first), instance_at(Viewpoint::second)},
                      argc, argv);
}
