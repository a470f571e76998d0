// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "ipc/msg/tracker_faults.hpp"
#include "services/pose/drift/calibration_watch.hpp"
#include "services/pose/landmark_feed.hpp"
#include "services/pose/pose_source.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

constexpr auto kSilence = 50ms;  ///< no sample for so long is worth a word

/// How long a source may wait for its next sample. One that also takes landmarks must soon get the
/// next ones; one of two views has been waited for already.
static Deadline turn_of(const pose::PoseSource& source) {
  if (source.views() == 0 || (source.needs_landmarks() && source.views() == 1))
    return Deadline::in(kSilence);
  return source.needs_landmarks() ? Deadline::now() : Deadline::in(5ms);
}

/// Compares a sample of the tracker, and all landmarks that have come, with the calibration.
static void watch_calibration(const msg::HandPoses& poses, pose::LandmarkFeed& landmarks,
                              pose::CalibrationWatch& watch, pose::DriftLog& log) {
  while (const auto seen = landmarks.next()) watch.see(*seen);
  watch.see(poses);
  log.tell(watch.drift());
}

/// Publishes the samples of the hand tracker to the ring pose.hands, also those without a hand, so
/// that readers see that the tracker works.
static void run_pose(service::Context& context) {
  if (pose::is_exclusive(context.rig().pose)) context.stand_by();
  const auto source =
      must(pose::open_pose_source(context.rig(), context.calibration(), context.epoch_ns()));
  context.stand_by();
  pose::LandmarkFeed landmarks({context.reader<msg::Landmarks>("landmarks.hands"),
                                context.reader<msg::Landmarks>("landmarks2.hands")},
                               context.calibration().id);
  auto hands = must(context.writer<msg::HandPoses>("pose.hands"));
  pose::CalibrationWatch watch(context.rig().pose.drift, context.calibration());
  pose::DriftLog drift_log;

  context.ready();
  auto sampled_ns = now_ns();
  while (context.running()) {
    if (source->views() > 0)
      if (const auto passed = landmarks.pass_on(*source); !passed) {
        if (passed.error().code != Errc::timeout) context.tolerate(passed.error());
        if (source->needs_landmarks()) continue;
      }
    msg::HandPoses poses;
    if (const auto sampled = source->sample(poses, turn_of(*source)); !sampled) {
      if (sampled.error().code != Errc::timeout || now_ns() - sampled_ns > to_ns(kSilence))
        context.tolerate(sampled.error());
      continue;
    }
    sampled_ns = now_ns();
    poses.calibration = source->depends_on_calibration() ? context.calibration().id : 0;
    hands.publish(poses);
    // A pose that the tracker predicted is of the future.
    const auto end_ns = now_ns(), begin_ns = std::min(poses.header.origin_ns, end_ns);
    std::vector<msg::StageMark> marks{
        {msg::Stage::sample, msg::detail_of(source->take_faults()), begin_ns, end_ns}};
    if (watch.is_on() && source->views() == 0) {
      watch_calibration(poses, landmarks, watch, drift_log);
      marks.push_back({msg::Stage::watch, msg::detail_of(watch.note()), end_ns, now_ns()});
    }
    context.mark(poses.header, marks);
  }
}

static Result<void> check_pose(const config::Rig& rig, const calib::Calibration& calibration) {
  return pose::check_pose_sources(rig, calibration);
}

int main(int argc, char** argv) {
  return service::run({.name = "pose",
                       .summary = "Delivers the hand poses of the tracker.",
                       .paced_by = "its device",
                       .publishes = {"pose.hands"},
                       .subscribes = {"landmarks.hands", "landmarks2.hands"},
                       .settings = {"pose.second", "pose.handover", "pose.drift"},
                       .backends = service::describe_rows(pose::pose_backends())},
                      argc, argv, run_pose, check_pose);
}
