// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/detector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ipc/base/clock.hpp"

namespace handcast::twin {
namespace {

constexpr int kIndexKnuckle = 5, kMiddleKnuckle = 9;
/// Landmarks of the fingers that merge, from the PIP to the tip.
constexpr int kIndexPip = 6, kMiddlePip = 10, kFromPipToTip = 3;

/// Both fingers where the mean of the two is.
void merge_fingers(msg::HandLandmarks& hand) {
  for (int i = 0; i < kFromPipToTip; ++i) {
    auto &index = hand.points[kIndexPip + i], &middle = hand.points[kMiddlePip + i];
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
    std::swap_ranges(&hand.points[kIndexKnuckle], &hand.points[kMiddleKnuckle],
                     &hand.points[kMiddleKnuckle]);
}

}  // namespace handcast::twin
