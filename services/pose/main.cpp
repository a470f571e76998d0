// SPDX-License-Identifier: Apache-2.0
#include "services/pose/pose_source.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// Publishes the samples of the hand tracker to the ring pose.hands, also those without a hand, so
/// that readers see that the tracker works.
static void run_pose(service::Context& context) {
  if (service::is_exclusive(context.rig().pose.backend, pose::pose_backends())) context.stand_by();
  const auto source =
      must(pose::open_pose_source(context.rig(), context.calibration(), context.epoch_ns()));
  context.stand_by();
  auto hands = must(context.writer<msg::HandPoses>("pose.hands"));

  context.ready();
  while (context.running()) {
    msg::HandPoses poses;
    if (const auto sampled = source->sample(poses, Deadline::in(50ms)); !sampled) {
      context.tolerate(sampled.error());
      continue;
    }
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
                       .backends = service::describe_rows(pose::pose_backends())},
                      argc, argv, run_pose, check_pose);
}
