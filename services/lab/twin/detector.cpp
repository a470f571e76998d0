// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/detector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/finger_errors.hpp"

namespace handcast::twin {
namespace {

/// Error along the finger, and across it. The mean of the squares is 1.
constexpr std::array<double, 2> kAlongAndAcross{0.75, 1.199};
/// Error by place on the finger: MCP, PIP, DIP, tip. With the wrist, the mean of the squares is 1.
constexpr std::array<double, 4> kByPlace{0.8, 0.9, 1.03, 1.25};
constexpr double kOfWrist = 0.7;
constexpr double kShort_px = 3;  ///< bones that appear shorter have no direction

double weight_of(int landmark) {
  return landmark == 0 ? kOfWrist : kByPlace[static_cast<std::size_t>((landmark - 1) % 4)];
}

int finger_of(int landmark) { return landmark == 0 ? -1 : (landmark - 1) / 4; }

/// Direction of the finger at a landmark, from the palm to the tip; shorter than 1 if the bone is
/// seen end-on.
glm::dvec2 along_finger(const std::array<glm::vec2, msg::kLandmarks>& points, int landmark) {
  const int from = landmark == 0 ? 0 : landmark % 4 == 1 ? 0 : landmark - 1;
  const int to = landmark == 0 ? 9 : landmark;
  const glm::dvec2 bone = glm::dvec2(points[to]) - glm::dvec2(points[from]);
  return bone / (glm::length(bone) + kShort_px);
}

}  // namespace

PoseNumbers pose_numbers(const JointFrames& camera_frames) {
  const Flexion flexion = flexion_of(camera_frames);
  PoseNumbers numbers;
  std::size_t n = 0;
  for (int f = 0; f < kFingers; ++f) {
    numbers[n++] = flexion[f][0];
    numbers[n++] = flexion[f][1];
  }
  const glm::dmat3 wrist(camera_frames[kWristJoint]);
  const glm::dvec3 seen_from = glm::normalize(glm::dvec3(camera_frames[kWristJoint][3]));
  for (const glm::dvec3& direction : {wrist[1], wrist[2], seen_from})
    for (int axis = 0; axis < 3; ++axis) numbers[n++] = direction[axis];
  return numbers;
}

/// The kernel is 1 / (1 + d^2 / 2 l^2): Gaussian kernels of many lengths, weighted by an
/// exponential distribution of 1 / length^2.
LandmarkBias::LandmarkBias(const config::TwinDetector& settings, int seed,
                           const std::array<float, kJoints>& radius_m)
    : settings_(settings), radius_m_(radius_m) {
  if (settings.bias_px <= 0) return;
  const Random random(seed, Stream::detector_bias);
  // The kernel falls to 1/e at this multiple of its length l.
  const double falls = std::sqrt(2 * (std::numbers::e - 1));
  const double length = kUsualPoseSpeed * settings.bias_ms * 1e-3 / falls;
  waves_.resize(kWaves);
  for (std::size_t w = 0; w < kWaves; ++w) {
    const double scale = std::sqrt(-std::log(1 - random.uniform(w, 0))) / length;
    waves_[w].phase = 2 * std::numbers::pi * random.uniform(w, 1);
    for (std::size_t n = 0; n < kPoseNumbers; ++n)
      waves_[w].frequency[n] = scale * random.normal(w, 2 + n);
  }
  for (std::size_t i = 0; i < msg::kLandmarks; ++i)
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t w = 0; w < kWaves; ++w)
        weights_[i][c][w] = std::sqrt(2.0 / kWaves) * random.normal(kWaves + 2 * i + c, w);
}

std::array<double, LandmarkBias::kWaves> LandmarkBias::waves_at(
    const JointFrames& camera_frames) const {
  const PoseNumbers pose = pose_numbers(camera_frames);
  std::array<double, kWaves> values;
  for (std::size_t w = 0; w < kWaves; ++w) {
    double angle = waves_[w].phase;
    for (std::size_t n = 0; n < kPoseNumbers; ++n) angle += waves_[w].frequency[n] * pose[n];
    values[w] = std::cos(angle);
  }
  return values;
}

std::array<glm::dvec2, msg::kLandmarks> LandmarkBias::at(
    renderer::Side side, const JointFrames& camera_frames,
    const std::array<glm::vec2, msg::kLandmarks>& truth) const {
  std::array<glm::dvec2, msg::kLandmarks> error{};
  if (settings_.bias_px <= 0) return error;
  const auto waves = waves_at(camera_frames);
  const double mirrored = side == renderer::Side::left ? 1 : -1;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    std::array<double, 2> part{};
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t w = 0; w < kWaves; ++w)
        part[c] += weights_[static_cast<std::size_t>(i)][c][w] * waves[w];
    const int joint = msg::kJointOfLandmark[i];
    const double hidden = hidden_place(camera_frames, radius_m_, finger_of(i),
                                       glm::dvec3(camera_frames[joint][3]), radius_m_[joint]);
    const double size_px =
        settings_.bias_px * weight_of(i) * (1 + (settings_.bias_hidden - 1) * hidden);
    const glm::dvec2 along = along_finger(truth, i), across(-along.y, along.x);
    error[static_cast<std::size_t>(i)] =
        size_px *
        (kAlongAndAcross[0] * part[0] * along + mirrored * kAlongAndAcross[1] * part[1] * across);
  }
  return error;
}

namespace {

constexpr int kIndexKnuckleLandmark = 5, kMiddleKnuckleLandmark = 9;
/// Landmarks of the fingers that merge, from the PIP to the tip.
constexpr int kIndexPipLandmark = 6, kMiddlePip = 10, kFromPipToTip = 3;

/// Both fingers where the mean of the two is.
void merge_fingers(msg::HandLandmarks& hand) {
  for (int i = 0; i < kFromPipToTip; ++i) {
    auto &index = hand.points[kIndexPipLandmark + i], &middle = hand.points[kMiddlePip + i];
    index.x_px = middle.x_px = (index.x_px + middle.x_px) / 2;
    index.y_px = middle.y_px = (index.y_px + middle.y_px) / 2;
  }
}

/// The first of the two random numbers of a landmark.
std::uint64_t draw_of(msg::Side side, std::size_t landmark) {
  return (static_cast<std::uint64_t>(side) * msg::kLandmarks + landmark) * 2;
}

}  // namespace

DetectorModel::DetectorModel(const config::TwinDetector& settings, int seed,
                             const calib::CameraModel& camera, const renderer::HandShape& person)
    : settings_(settings),
      seed_(seed),
      camera_(camera),
      bias_(settings, seed, renderer::joint_radii_m(person)) {}

std::int64_t DetectorModel::age_ns(std::uint64_t run) const {
  const double age_ms =
      settings_.age_ms + settings_.age_sd_ms * Random(seed_, Stream::detector_age).normal(run);
  return ms_to_ns(std::max(age_ms, std::min(1.0, settings_.age_ms)));
}

bool DetectorModel::lost(std::uint64_t run, std::int64_t origin_ns) const {
  return settings_.lost.holds(ns_to_seconds(origin_ns)) ||
         Random(seed_, Stream::detector_loss).uniform(run) < settings_.dropout;
}

std::int64_t DetectorModel::stamp_ns(std::int64_t frame_stamp_ns) const {
  return frame_stamp_ns + ms_to_ns(settings_.clock_skew_ms);
}

/// Displacement of one landmark: zero unless it is an outlier.
glm::dvec2 DetectorModel::outlier_px(const Outliers& outliers, std::uint64_t run,
                                     std::uint64_t draw) const {
  const Random random(seed_, outliers.stream);
  if (outliers.share <= random.uniform(run, 2 * draw)) return glm::dvec2(0);
  const double angle = std::numbers::pi * random.spread(run, 2 * draw + 1);
  const double far_px = outliers.nearest_px + (outliers.farthest_px - outliers.nearest_px) *
                                                  random.uniform(run, 2 * draw + 2);
  return {far_px * std::cos(angle), far_px * std::sin(angle)};
}

msg::HandLandmarks DetectorModel::report(std::uint64_t run, msg::Side side,
                                         const std::array<glm::vec2, msg::kLandmarks>& truth,
                                         const renderer::JointFrames& camera_frames,
                                         std::int64_t origin_ns) const {
  const Random random(seed_, Stream::detector_noise);
  const auto bias_px = bias_.at(side, camera_frames, truth);
  msg::HandLandmarks hand;
  hand.side = side;
  hand.presence = 0.95f;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::uint64_t draw = draw_of(side, i);
    const glm::dvec2 noise(random.normal(run, draw), random.normal(run, draw + 1));
    const glm::dvec2 seen = glm::dvec2(truth[i]) + bias_px[i] + noise * settings_.noise_px;
    const bool inside = camera_.contains(camera_.distort(truth[i]));
    hand.points[i] = {static_cast<float>(seen.x), static_cast<float>(seen.y), inside ? 1.0f : 0.0f};
  }
  spoil(run, origin_ns, hand);
  return hand;
}

void DetectorModel::spoil(std::uint64_t run, std::int64_t origin_ns,
                          msg::HandLandmarks& hand) const {
  const Outliers far{settings_.outliers, 40, 200, Stream::detector_outlier},
      near{settings_.near_outliers, 5, 40, Stream::detector_near};
  for (std::size_t i = 0; i < msg::kLandmarks; ++i) {
    const std::uint64_t draw = draw_of(hand.side, i);
    const glm::dvec2 moved_px = outlier_px(far, run, draw) + outlier_px(near, run, draw);
    hand.points[i].x_px += static_cast<float>(moved_px.x);
    hand.points[i].y_px += static_cast<float>(moved_px.y);
  }
  const double seconds = ns_to_seconds(origin_ns);
  if (settings_.merged.holds(seconds)) merge_fingers(hand);
  if (settings_.wrong_finger.holds(seconds))
    std::swap_ranges(&hand.points[kIndexKnuckleLandmark], &hand.points[kMiddleKnuckleLandmark],
                     &hand.points[kMiddleKnuckleLandmark]);
}

}  // namespace handcast::twin
