// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/clock.hpp"

namespace handcast::twin {
namespace {

constexpr int kIndexMetacarpal = 6, kMiddleMetacarpal = 11;
/// Offset and drift along the camera's axis relative to those across it.
constexpr double kDepthShare = 0.3;
constexpr double kMinDrift_hz = 0.2, kMaxDrift_hz = 1.5;
/// Jitter of the sample times, and the shortest time between two samples that it leaves: periods.
constexpr double kJitter = 0.03, kMostJitter = 0.2, kShortestPeriod = 1 - 2 * kMostJitter;
/// Time in which half of the way to the rest pose is gone, while the pose decays.
constexpr double kSinks_s = 0.2;
/// The wrist's lag as a share of the fingers'.
constexpr double kWristLag = 1.0 / 3;

std::uint64_t index(Side side, int joint, int axis) {
  return (static_cast<std::uint64_t>(side) * msg::kJoints + static_cast<std::uint64_t>(joint)) * 3 +
         static_cast<std::uint64_t>(axis);
}

/// The part of the hand that a joint belongs to: 0 the palm and the wrist, 1 the thumb ...
int part_of(int joint) {
  int part = 0;
  for (int f = 0; f < kFingers; ++f) part += joint >= kMetacarpalJoint[f];
  return part;
}

}  // namespace

TrackerModel::TrackerModel(const config::TwinTracker& settings, int seed,
                           const calib::Calibration& calibration, const renderer::HandShape& person)
    : settings_(settings),
      seed_(seed),
      fx_px_(calibration.camera.fx_px),
      camera_from_tracker_(calibration.camera_from_tracker),
      radius_m_(renderer::joint_radii_m(person)),
      rest_{rest_pose(Side::left, person), rest_pose(Side::right, person)},
      fingers_(settings, seed, radius_m_),
      clock_(settings.clock, settings.clock_skew_ms,
             seconds_to_ns(kShortestPeriod / settings.rate_hz),
             Random(seed, Stream::tracker_clock)) {
  for (float& radius : radius_m_) radius *= static_cast<float>(settings.scale);
  for (const Side side : {Side::left, Side::right}) {
    places_[static_cast<std::size_t>(side)] = draw_place(side);
    draw_waves(side);
  }
  draw_joint_offsets();
}

TrackerModel::Place TrackerModel::draw_place(Side side) const {
  const Random random(seed_, Stream::tracker_place);
  const auto hand = static_cast<std::uint64_t>(side);
  const glm::dmat3 tracker_from_camera = glm::transpose(glm::dmat3(camera_from_tracker_));
  const double angle = std::numbers::pi * random.spread(hand, 0);
  const glm::dvec3 away(std::cos(angle), std::sin(angle), kDepthShare * random.spread(hand, 1));
  const glm::dvec3 axis(random.normal(hand, 2), random.normal(hand, 3), random.normal(hand, 4));
  const glm::dmat4 turn =
      glm::rotate(glm::dmat4(1), glm::radians(settings_.rotation_deg), glm::normalize(axis));
  return {glm::dmat3(turn),
          tracker_from_camera * glm::normalize(away) * (settings_.offset_mm * 1e-3)};
}

void TrackerModel::draw_waves(Side side) {
  const auto draw = [](const Random& random, std::uint64_t index, Waves& waves) {
    for (std::uint64_t w = 0; w < kWaves; ++w) {
      const double hz = kMinDrift_hz + (kMaxDrift_hz - kMinDrift_hz) * random.uniform(index, 2 * w);
      const double phase = 2 * std::numbers::pi * random.uniform(index, 2 * w + 1);
      waves[w] = {2 * std::numbers::pi * hz, phase};
    }
  };
  const Random joints(seed_, Stream::tracker_drift), parts(seed_, Stream::tracker_fingers);
  auto& waves = waves_[static_cast<std::size_t>(side)];
  for (int j = 0; j < kDrifting; ++j)
    for (int axis = 0; axis < 3; ++axis)
      draw(j < msg::kJoints ? joints : parts, index(side, j % msg::kJoints, axis), waves[j][axis]);
}

void TrackerModel::draw_joint_offsets() {
  const Random random(seed_, Stream::tracker_joints);
  const double axis_m = settings_.joint_offset_mm * 1e-3 / std::sqrt(3.0);
  for (std::uint64_t j = 0; j < joint_offset_m_.size(); ++j)
    joint_offset_m_[j] =
        axis_m * glm::dvec3(random.normal(j, 0), random.normal(j, 1), random.normal(j, 2));
}

std::int64_t TrackerModel::sample_ns(std::uint64_t k) const {
  const double jitter = std::clamp(kJitter * Random(seed_, Stream::tracker_time).normal(k),
                                   -kMostJitter, kMostJitter);
  return seconds_to_ns((static_cast<double>(k) + jitter) / settings_.rate_hz);
}

std::int64_t TrackerModel::alone_ns(std::uint64_t k) const {
  const double age_ms =
      settings_.age_ms + settings_.age_sd_ms * Random(seed_, Stream::tracker_age).normal(k);
  return sample_ns(k) + ms_to_ns(std::max(age_ms, std::min(1.0, settings_.age_ms)));
}

std::int64_t TrackerModel::arrival_ns(std::uint64_t k) const {
  return burst_arrival_ns(k, settings_.burst, Random(seed_, Stream::tracker_burst),
                          [this](std::uint64_t i) { return alone_ns(i); });
}

bool TrackerModel::lost(std::uint64_t k) const {
  return settings_.lost.holds(ns_to_seconds(sample_ns(k))) ||
         Random(seed_, Stream::tracker_loss).uniform(k) < settings_.dropout;
}

/// The sample that `k` repeats: the last one before the tracker froze or its pose began to decay.
std::uint64_t TrackerModel::shown_sample(std::uint64_t k) const {
  auto shown = k;
  for (const auto* fault : {&settings_.frozen, &settings_.decaying}) {
    if (!fault->holds(ns_to_seconds(sample_ns(k)))) continue;
    auto last = std::min(k, static_cast<std::uint64_t>(fault->at_s * settings_.rate_hz) + 1);
    while (last > 0 && fault->holds(ns_to_seconds(sample_ns(last)))) --last;
    shown = std::min(shown, last);
  }
  return shown;
}

bool TrackerModel::knows_sides(std::uint64_t k) const {
  return !settings_.swapped.holds(ns_to_seconds(sample_ns(k)));
}

/// How far the pose of sample `k` has sunk towards the rest pose.
double TrackerModel::sunk_share(std::uint64_t k) const {
  const double seconds = ns_to_seconds(sample_ns(k));
  if (!settings_.decaying.holds(seconds)) return 0;
  return 1 - std::exp2(-(seconds - settings_.decaying.at_s) / kSinks_s);
}

/// The sum of n sines of different frequencies with amplitude sqrt(2/n) has an RMS of 1.
glm::dvec3 TrackerModel::waves_at(Side side, int drifting, double seconds) const {
  glm::dvec3 sum(0);
  for (int axis = 0; axis < 3; ++axis)
    for (const Wave& wave : waves_[static_cast<std::size_t>(side)][drifting][axis])
      sum[axis] += std::sin(wave.rad_s * seconds + wave.phase);
  return sum * std::sqrt(2.0 / kWaves);
}

glm::dvec3 TrackerModel::drift_m(Side side, int joint, double seconds, double distance_m) const {
  const double common = settings_.finger_correlation;
  glm::dvec3 drift = std::sqrt(1 - common) * waves_at(side, joint, seconds);
  if (common > 0)
    drift += std::sqrt(common) * waves_at(side, msg::kJoints + part_of(joint), seconds);
  drift.z *= kDepthShare;
  return drift * (settings_.drift_px * distance_m / fx_px_);
}

glm::dvec3 TrackerModel::noise_m(std::uint64_t k, Side side, int joint) const {
  const Random random(seed_, Stream::tracker_noise);
  return glm::dvec3(random.normal(k, index(side, joint, 0)),
                    random.normal(k, index(side, joint, 1)),
                    random.normal(k, index(side, joint, 2))) *
         (settings_.noise_mm * 1e-3);
}

/// The fingers as they were lag_ms ago, on the wrist as it was lag_ms / 3 ago. A hand that has only
/// just come has no past.
std::optional<JointFrames> TrackerModel::lagging(std::int64_t time_ns,
                                                 const JointsAt& truth) const {
  const auto now = truth(time_ns);
  if (!now || settings_.lag_ms <= 0) return now;
  const auto fingers = truth(time_ns - ms_to_ns(settings_.lag_ms)),
             wrist = truth(time_ns - ms_to_ns(settings_.lag_ms * kWristLag));
  if (!fingers || !wrist) return now;
  const glm::dmat4 later =
      glm::dmat4((*wrist)[kWristJoint]) * glm::inverse(glm::dmat4((*fingers)[kWristJoint]));
  JointFrames seen;
  for (int j = 0; j < msg::kJoints; ++j) seen[j] = glm::mat4(later * glm::dmat4((*fingers)[j]));
  return seen;
}

/// The hand with the errors of its fingers and joints, in its true place and size.
JointFrames TrackerModel::seen(std::uint64_t k, std::uint64_t shown, Side side,
                               const JointFrames& truth) const {
  const auto i = static_cast<std::size_t>(side);
  JointFrames hand = fingers_.seen(side, ns_to_seconds(sample_ns(shown)), truth);
  if (const double share = sunk_share(k); share > 0) hand = nearer_to(hand, rest_[i], share);
  for (int j = 0; j < msg::kJoints; ++j) {
    glm::dvec3 offset_m = joint_offset_m_[j];
    if (side == Side::right) offset_m.x = -offset_m.x;
    hand[j][3] += glm::vec4(glm::dmat3(hand[j]) * offset_m, 0);
  }
  if (settings_.merged.holds(ns_to_seconds(sample_ns(k)))) hand = merged(hand);
  return hand;
}

/// The message: the hand in the place and size that the tracker gives it, with drift and noise.
msg::HandPose TrackerModel::placed(std::uint64_t shown, Side side, const JointFrames& seen) const {
  const Place& place = places_[static_cast<std::size_t>(side)];
  const glm::dmat3 tracker_from_camera = glm::transpose(glm::dmat3(camera_from_tracker_));
  const glm::dvec3 wrist(seen[kWristJoint][3]);
  const double distance_m = (camera_from_tracker_ * glm::dvec4(wrist, 1)).z;
  const double seconds = ns_to_seconds(sample_ns(shown));
  msg::HandPose pose;
  pose.side = side;
  pose.confidence = 1;
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::dvec3 arm = glm::dvec3(seen[j][3]) - wrist;
    const glm::dvec3 at = wrist + place.turn * arm * settings_.scale + place.offset_m +
                          tracker_from_camera * drift_m(side, j, seconds, distance_m) +
                          noise_m(shown, side, j);
    const glm::dquat axes = glm::quat_cast(place.turn * glm::dmat3(seen[j]));
    pose.joints[j].position_m = {float(at.x), float(at.y), float(at.z)};
    pose.joints[j].orientation_xyzw = {float(axes.x), float(axes.y), float(axes.z), float(axes.w)};
    pose.joints[j].radius_m = radius_m_[j];
  }
  return pose;
}

std::optional<msg::HandPose> TrackerModel::report(std::uint64_t k, Side side,
                                                  const JointsAt& truth) const {
  const std::uint64_t shown = shown_sample(k);
  const auto hand = lagging(sample_ns(shown), truth);
  if (!hand) return std::nullopt;
  auto pose = placed(shown, side, seen(k, shown, side, *hand));
  if (settings_.wrong_finger.holds(ns_to_seconds(sample_ns(k))))
    std::swap_ranges(&pose.joints[kIndexMetacarpal], &pose.joints[kMiddleMetacarpal],
                     &pose.joints[kMiddleMetacarpal]);
  return pose;
}

}  // namespace handcast::twin
