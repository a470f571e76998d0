// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stereo_trial.hpp"

#include <ctime>

#include "ipc/base/clock.hpp"
#include "renderer/predict/pose_history.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/pose/stereo/stereo_tracker.hpp"
#include "tests/bench/seeing_eye.hpp"

namespace handcast::bench {
namespace {

double thread_time_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

/// The bend of a finger: from its metacarpal to its last bone, rad.
double bend_of(const renderer::JointFrames& truth, int finger) {
  const int first = 1 + 5 * finger;
  const auto along = [&](int joint) { return -glm::normalize(glm::dvec3(truth[joint][2])); };
  return std::acos(std::clamp(glm::dot(along(first), along(first + 3)), -1.0, 1.0));
}

double error_mm(const renderer::JointFrames& truth, const msg::HandPose& pose, int joint) {
  const auto& at = pose.joints[joint].position_m;
  return 1e3 * glm::distance(glm::dvec3(truth[joint][3]), glm::dvec3(at[0], at[1], at[2]));
}

/// Compares a sample with the true hands at `time_ns`.
void compare(const twin::Twin& twin, const msg::HandPoses& poses, std::int64_t time_ns,
             JointErrors& errors) {
  constexpr double kOpen_rad = 1.05, kFolded_rad = 1.75;
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto truth = twin.joints(side, time_ns);
    if (!truth) continue;
    ++errors.hands;
    const auto* pose = poses.find(side);
    if (!pose) {
      ++errors.missing;
      continue;
    }
    bool is_open = true;
    for (int f = 1; f < 5; ++f) {
      const double bend = bend_of(*truth, f);
      is_open = is_open && bend < kOpen_rad;
      if (bend > kFolded_rad) errors.folded_tips_mm.push_back(error_mm(*truth, *pose, 5 + 5 * f));
    }
    for (const int joint : msg::kJointOfLandmark) {
      const double mm = error_mm(*truth, *pose, joint);
      errors.all_mm.push_back(mm);
      if (is_open) errors.open_mm.push_back(mm);
    }
  }
}

constexpr int kPalmJoint = 0;

/// The pose is where the other hand is.
bool is_exchanged(const twin::Twin& twin, const msg::HandPose& pose, std::int64_t time_ns) {
  constexpr double kFar_mm = 1e4;
  const auto far_mm = [&](msg::Side side) {
    const auto truth = twin.joints(side, time_ns);
    return truth ? error_mm(*truth, pose, kPalmJoint) : kFar_mm;
  };
  const auto other = pose.side == msg::Side::left ? msg::Side::right : msg::Side::left;
  return far_mm(other) < far_mm(pose.side);
}

/// Counts exchanged hands, and the samples in a row that have one.
class Exchanges {
 public:
  void add(const twin::Twin& twin, const msg::HandPoses& poses, JointErrors& errors) {
    const std::int64_t time_ns = poses.header.origin_ns;
    int exchanged = 0;
    for (std::uint32_t h = 0; h < poses.count; ++h)
      exchanged += is_exchanged(twin, poses.hands[h], time_ns);
    errors.poses += static_cast<int>(poses.count);
    errors.exchanged += exchanged;
    if (exchanged > 0 && !is_on_) is_on_ = true, began_ns_ = time_ns;
    if (exchanged > 0) last_ns_ = time_ns;
    if (exchanged == 0 && poses.count > 0) end(errors);
  }
  void end(JointErrors& errors) {
    if (is_on_) errors.exchanges_s.push_back(ns_to_seconds(last_ns_ - began_ns_));
    is_on_ = false;
  }

 private:
  bool is_on_ = false;
  std::int64_t began_ns_ = 0, last_ns_ = 0;
};

void add_misses(const SeeingEye& eye, const msg::Landmarks& seen, std::vector<double>& mm) {
  for (const auto& miss : eye.compare(seen)) mm.push_back(miss.mm);
}

/// The poses of a source as the predictor of the cascade has them later.
class Later {
 public:
  explicit Later(const config::Predict& settings)
      : histories_{PoseHistory(settings), PoseHistory(settings)} {}

  /// Adds a sample; compares where its hands are predicted to be kLater_ns after it.
  void add(const twin::Twin& twin, const msg::HandPoses& poses, std::vector<double>& errors_mm) {
    const std::int64_t then_ns = poses.header.origin_ns + kLater_ns;
    for (std::uint32_t h = 0; h < poses.count; ++h) {
      auto& history = histories_[static_cast<std::size_t>(poses.hands[h].side)];
      history.push(poses.header.origin_ns, poses.hands[h]);
      const auto truth = twin.joints(poses.hands[h].side, then_ns);
      const auto pose = history.at(then_ns);
      if (!truth || !pose || !history.settled()) continue;
      for (const int joint : msg::kJointOfLandmark)
        errors_mm.push_back(error_mm(*truth, *pose, joint));
    }
  }

 private:
  using PoseHistory = renderer::PoseHistory;
  static constexpr std::int64_t kLater_ns = 16'000'000;
  std::array<PoseHistory, msg::kMaxHands> histories_;
};

void compare_tracker(const twin::Twin& twin, double seconds, const config::Predict& predict,
                     JointErrors& errors) {
  Later later(predict);
  for (std::uint64_t k = 0; ns_to_seconds(twin.tracker_time_ns(k)) < seconds; ++k) {
    const auto poses = twin.tracker_sample(k).poses;
    compare(twin, poses, twin.tracker_time_ns(k), errors);
    later.add(twin, poses, errors.later_mm);
  }
}

}  // namespace

void JointErrors::add(const JointErrors& more) {
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(all_mm, more.all_mm);
  append(open_mm, more.open_mm);
  append(folded_tips_mm, more.folded_tips_mm);
  append(later_mm, more.later_mm);
  hands += more.hands;
  missing += more.missing;
  append(exchanges_s, more.exchanges_s);
  poses += more.poses;
  exchanged += more.exchanged;
}

Result<StereoTrial> run_trial(const StereoRig& stereo, config::Rig rig, const TrialPlan& plan) {
  const auto& [seconds, hints, anew_s] = plan;
  rig.twin.image.gain = stereo.gain;
  rig.landmarks.backend = "handcast";
  rig.camera2 = rig.camera;
  rig.landmarks2 = rig.landmarks;
  rig.pose.backend = hints ? "stereo" : "none";
  const auto twin = twin::Twin::create(rig, calib::reference_rig());
  if (!twin) return tl::make_unexpected(twin.error());
  const auto open = [&](config::Viewpoint at, int seed) {
    auto moved = rig;
    moved.twin.seed += seed;
    return SeeingEye::open(stereo.calibration, at, stereo.rows_per_row, moved, **twin);
  };
  auto first = open(config::Viewpoint::first, 0);
  auto second = open(config::Viewpoint::second, 1000);
  if (!first) return tl::make_unexpected(first.error());
  if (!second) return tl::make_unexpected(second.error());
  auto tracker =
      pose::stereo::StereoTracker::open(rig, pose::stereo::views_of(stereo.calibration).value(),
                                        glm::inverse(stereo.calibration.camera_from_tracker));
  if (!tracker) return tl::make_unexpected(tracker.error());
  const auto unused = *tracker;
  StereoTrial trial;
  Later later(rig.cascade.predict);
  Exchanges exchanges;
  std::int64_t begun_ns = 0;
  const auto samples = static_cast<std::uint64_t>(seconds * stereo.rate_hz);
  for (std::uint64_t k = 0; k < samples; ++k) {
    const auto time_ns = seconds_to_ns(static_cast<double>(k + 1) / stereo.rate_hz);
    if (anew_s > 0 && time_ns - begun_ns >= seconds_to_ns(anew_s)) {
      begun_ns = time_ns;
      *tracker = unused;
      for (auto* eye : {&*first, &*second})
        if (auto forgot = (*eye)->forget(); !forgot) return tl::make_unexpected(forgot.error());
      exchanges.end(trial.stereo);
    }
    const auto here = (*first)->look(k, time_ns, hints);
    const auto there = (*second)->look(k, time_ns + ms_to_ns(stereo.second_later_ms), hints);
    if (!here) return tl::make_unexpected(here.error());
    if (!there) return tl::make_unexpected(there.error());
    add_misses(**first, *here, trial.landmarks_mm);
    add_misses(**second, *there, trial.landmarks_mm);
    const double begin_us = thread_time_us();
    const auto poses = tracker->sample({&*here, &*there});
    trial.work_us.push_back(thread_time_us() - begin_us);
    (*first)->tell(poses);
    (*second)->tell(poses);
    compare(**twin, poses, poses.header.origin_ns, trial.stereo);
    later.add(**twin, poses, trial.stereo.later_mm);
    exchanges.add(**twin, poses, trial.stereo);
  }
  exchanges.end(trial.stereo);
  compare_tracker(**twin, seconds, rig.cascade.predict, trial.tracker);
  return trial;
}

}  // namespace handcast::bench
