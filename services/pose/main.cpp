// SPDX-License-Identifier: Apache-2.0
#include "ipc/msg/same_calibration.hpp"
#include "services/pose/pose_source.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// Passes the newest landmarks to the source; waits for them. A timeout is no fault of this
/// service: the first landmarks come after it is ready.
static Result<void> see_landmarks(Result<ipc::Reader<msg::Landmarks>>& landmarks,
                                  std::uint32_t calibration, pose::PoseSource& source) {
  if (!landmarks) return tl::make_unexpected(landmarks.error());
  const auto seen = landmarks->latest(Deadline::in(50ms));
  if (!seen) return tl::make_unexpected(seen.error());
  if (auto ours = msg::check_calibration(**seen, calibration); !ours) return ours;
  source.see(**seen);
  return {};
}

/// Publishes the samples of the hand tracker to the ring pose.hands, also those without a hand, so
/// that readers see that the tracker works.
static void run_pose(service::Context& context) {
  if (service::is_exclusive(context.rig().pose.backend, pose::pose_backends())) context.stand_by();
  const auto source =
      must(pose::open_pose_source(context.rig(), context.calibration(), context.epoch_ns()));
  context.stand_by();
  auto landmarks = context.reader<msg::Landmarks>("landmarks.hands");
  auto hands = must(context.writer<msg::HandPoses>("pose.hands"));

  context.ready();
  while (context.running()) {
    if (source->needs_landmarks())
      if (const auto seen = see_landmarks(landmarks, context.calibration().id, *source); !seen) {
        if (seen.error().code != Errc::timeout) context.tolerate(seen.error());
        continue;
      }
    msg::HandPoses poses;
    if (const auto sampled = source->sample(poses, Deadline::in(50ms)); !sampled) {
      context.tolerate(sampled.error());
      continue;
    }
    poses.calibration = source->needs_landmarks() ? context.calibration().id : 0;
    hands.publish(poses);
    context.mark(poses.header, std::array{msg::StageMark{msg::Stage::sample, 0,
                                                         poses.header.origin_ns, now_ns()}});
  }
}

static Result<void> check_pose(const config::Rig& rig, const calib::Calibration& calibration) {
  return service::check_backend("pose", rig.pose.backend, pose::pose_backends(), rig, calibration,
                                now_ns());
}

int main(int argc, char** argv) {
  return service::run({.name = "pose",
                       .summary = "Delivers the hand poses of the tracker.",
                       .paced_by = "its device",
                       .publishes = {"pose.hands"},
                       .subscribes = {"landmarks.hands"},
                       .backends = service::describe_rows(pose::pose_backends())},
                      argc, argv, run_pose, check_pose);
}
