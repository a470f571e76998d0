// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/log.hpp"
#include "ipc/msg/detector_note.hpp"
#include "ipc/msg/same_calibration.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/second_view.hpp"

using namespace handcast;
using namespace std::chrono_literals;
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

/// Publishes the landmarks of the newest camera frame on landmarks.hands, back to back. Frames that
/// arrive during a detection are skipped.
static void run_landmarks(service::Context& context) {
  const auto choice = landmarks::choose_detector(context.rig());
  const msg::DetectorNote note{.is_fallback = !choice.why.empty()};
  if (!choice.why.empty()) log::warning("{}", choice.why);
  if (service::is_exclusive(choice.backend, landmarks::detector_backends())) context.stand_by();
  const auto detector =
      must(landmarks::open_detector(context.rig(), context.calibration(), context.epoch_ns()));
  context.stand_by();
  auto frames = must(context.reader<msg::CameraFrame>("camera.frames"));
  auto poses = context.reader<msg::HandPoses>("pose.hands");
  landmarks::TrackerHints tracker(context.calibration());
  auto hands = must(context.writer<msg::Landmarks>("landmarks.hands"));

  context.ready();
  while (context.running()) {
    const auto frame = frames.latest(Deadline::in(50ms));
    if (!frame) {
      context.tolerate(frame.error());
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

static Result<void> check_landmarks(const config::Rig& rig, const calib::Calibration& calibration) {
  if (auto known = landmarks::check_fallback(rig); !known) return known;
  auto chosen = rig;
  chosen.landmarks.backend = landmarks::choose_detector(rig).backend;
  return service::check_backend("landmarks", chosen.landmarks.backend,
                                landmarks::detector_backends(), chosen, calibration, now_ns());
}

/// HANDCAST_SECOND_VIEW: this program is handcast-landmarks2.
static daemon::ServiceDescription description() {
  daemon::ServiceDescription first{
      .name = "landmarks",
      .summary = "Finds the landmarks of the hands in camera images.",
      .paced_by = "camera.frames",
      .publishes = {"landmarks.hands"},
      .subscribes = {"camera.frames", "pose.hands"},
      .settings = {"landmarks.fallback"},
      .backends = service::describe_rows(landmarks::detector_backends())};
#ifdef HANDCAST_SECOND_VIEW
  return service::of_second_view(std::move(first));
#else
  return first;
#endif
}

int main(int argc, char** argv) {
  return service::run(description(), argc, argv, run_landmarks, check_landmarks);
}
