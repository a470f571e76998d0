// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/twin/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/clock.hpp"

namespace handcast::twin {
namespace {

constexpr int kWrist = 1, kIndexMetacarpal = 6, kMiddleMetacarpal = 11;
/// Offset and drift along the camera's axis relative to those across it.
constexpr double kDepthShare = 0.3;
constexpr double kMinDrift_hz = 0.2, kMaxDrift_hz = 1.5;

std::uint64_t index(Side side, int joint, int axis) {
  return (static_cast<std::uint64_t>(side) * msg::kJoints + static_cast<std::uint64_t>(joint)) * 3 +
         static_cast<std::uint64_t>(axis);
}

}  // namespace

TrackerModel::TrackerModel(const config::TwinTracker& settings, int seed,
                           const calib::Calibration& calibration, const renderer::HandShape& person)
    : settings_(settings),
      seed_(seed),
      fx_px_(calibration.camera.fx_px),
      camera_from_tracker_(calibration.camera_from_tracker) {
  radius_m_ = renderer::joint_radii_m(person);
  for (float& radius : radius_m_) radius *= static_cast<float>(settings.scale);
  for (const Side side : {Side::left, Side::right}) {
    places_[static_cast<std::size_t>(side)] = draw_place(side);
    draw_waves(side);
  }
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
  const Random random(seed_, Stream::tracker_drift);
  for (int j = 0; j < msg::kJoints; ++j)
    for (int axis = 0; axis < 3; ++axis)
      for (std::uint64_t w = 0; w < kWaves; ++w) {
        const double hz = kMinDrift_hz + (kMaxDrift_hz - kMinDrift_hz) *
                                             random.uniform(index(side, j, axis), 2 * w);
        const double phase = 2 * std::numbers::pi * random.uniform(index(side, j, axis), 2 * w + 1);
        waves_[static_cast<std::size_t>(side)][j][axis][w] = {2 * std::numbers::pi * hz, phase};
      }
}

std::int64_t TrackerModel::sample_ns(std::uint64_t k) const {
  const double jitter = std::clamp(0.03 * Random(seed_, Stream::tracker_time).normal(k), -0.2, 0.2);
  return seconds_to_ns((static_cast<double>(k) + jitter) / settings_.rate_hz);
}

std::int64_t TrackerModel::arrival_ns(std::uint64_t k) const {
  const double age_ms =
      settings_.age_ms + settings_.age_sd_ms * Random(seed_, Stream::tracker_age).normal(k);
  return sample_ns(k) + ms_to_ns(std::max(age_ms, std::min(1.0, settings_.age_ms)));
}

std::int64_t TrackerModel::stamp_ns(std::uint64_t k) const {
  return sample_ns(k) + ms_to_ns(settings_.clock_skew_ms);
}

bool TrackerModel::lost(std::uint64_t k) const {
  return settings_.lost.holds(ns_to_seconds(sample_ns(k))) ||
         Random(seed_, Stream::tracker_loss).uniform(k) < settings_.dropout;
}

std::uint64_t TrackerModel::shown_sample(std::uint64_t k) const {
  if (!settings_.frozen.holds(ns_to_seconds(sample_ns(k)))) return k;
  // Searches backwards for the last sample before the fault.
  auto last =
      std::min(k, static_cast<std::uint64_t>(settings_.frozen.at_s * settings_.rate_hz) + 1);
  while (last > 0 && settings_.frozen.holds(ns_to_seconds(sample_ns(last)))) --last;
  return last;
}

bool TrackerModel::knows_sides(std::uint64_t k) const {
  return !settings_.swapped.holds(ns_to_seconds(sample_ns(k)));
}

/// The sum of n sines of different frequencies with amplitude sqrt(2/n) has an RMS of 1.
glm::dvec3 TrackerModel::drift_m(Side side, int joint, double seconds, double distance_m) const {
  glm::dvec3 drift(0);
  for (int axis = 0; axis < 3; ++axis)
    for (const Wave& wave : waves_[static_cast<std::size_t>(side)][joint][axis])
      drift[axis] += std::sin(wave.rad_s * seconds + wave.phase);
  drift.z *= kDepthShare;
  return drift * (std::sqrt(2.0 / kWaves) * settings_.drift_px * distance_m / fx_px_);
}

glm::dvec3 TrackerModel::noise_m(std::uint64_t k, Side side, int joint) const {
  const Random random(seed_, Stream::tracker_noise);
  return glm::dvec3(random.normal(k, index(side, joint, 0)),
                    random.normal(k, index(side, joint, 1)),
                    random.normal(k, index(side, joint, 2))) *
         (settings_.noise_mm * 1e-3);
}

msg::HandPose TrackerModel::report(std::uint64_t k, Side side, const JointFrames& truth) const {
  const Place& place = places_[static_cast<std::size_t>(side)];
  const glm::dmat3 tracker_from_camera = glm::transpose(glm::dmat3(camera_from_tracker_));
  const glm::dvec3 wrist(truth[kWrist][3]);
  const double distance_m = (camera_from_tracker_ * glm::dvec4(wrist, 1)).z;
  const double seconds = ns_to_seconds(sample_ns(k));

  msg::HandPose pose;
  pose.side = side;
  pose.confidence = 1;
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::dvec3 arm = glm::dvec3(truth[j][3]) - wrist;
    const glm::dvec3 seen = wrist + place.turn * arm * settings_.scale + place.offset_m +
                            tracker_from_camera * drift_m(side, j, seconds, distance_m) +
                            noise_m(k, side, j);
    const glm::dquat axes = glm::quat_cast(place.turn * glm::dmat3(truth[j]));
    pose.joints[j].position_m = {float(seen.x), float(seen.y), float(seen.z)};
    pose.joints[j].orientation_xyzw = {float(axes.x), float(axes.y), float(axes.z), float(axes.w)};
    pose.joints[j].radius_m = radius_m_[j];
  }
  if (settings_.wrong_finger.holds(seconds))
    std::swap_ranges(&pose.joints[kIndexMetacarpal], &pose.joints[kMiddleMetacarpal],
                     &pose.joints[kMiddleMetacarpal]);
  return pose;
}

}  // namespace handcast::twin
