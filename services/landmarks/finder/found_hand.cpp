// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/found_hand.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ipc/base/statistics.hpp"

namespace handcast::landmarks {
namespace {

// Lengths, as fractions of the region's side, which is about two and a half palms.
constexpr float kMostSigma = 0.1f;   ///< a landmark with this sigma has no confidence
constexpr float kAgrees = 0.08f;     ///< the usual error of a tracker's finger
constexpr float kDiffers = 0.2f;     ///< from the tip of one finger to that of its neighbour
constexpr float kMostShift = 0.16f;  ///< the largest error of a tracker in a hand's position

constexpr float kLeastTrust = 0.3f;  ///< factor of a landmark that contradicts the tracker

/// The shift from the tracker's hand to the estimated one, at most `most_px` long.
glm::vec2 shift_px(const Points& estimated_px, const Points& tracker_px, float most_px) {
  Confidences right_px, down_px;
  for (std::size_t i = 0; i < estimated_px.size(); ++i) {
    right_px[i] = estimated_px[i].x - tracker_px[i].x;
    down_px[i] = estimated_px[i].y - tracker_px[i].y;
  }
  const glm::vec2 shift(median(right_px), median(down_px));
  return shift * std::min(1.0f, most_px / std::max(glm::length(shift), most_px));
}

}  // namespace

Confidences confidences_of(const LandmarkEstimate& estimate, const Region& region,
                           const std::optional<Points>& tracker_px) {
  const glm::vec2 shift =
      tracker_px ? shift_px(estimate.points_px, *tracker_px, kMostShift * region.size_px)
                 : glm::vec2(0);
  Confidences confidences;
  for (std::size_t i = 0; i < confidences.size(); ++i) {
    const float certainty =
        std::max(0.0f, 1 - estimate.sigma_px[i] / (kMostSigma * region.size_px));
    const float apart =
        tracker_px ? glm::distance(estimate.points_px[i], (*tracker_px)[i] + shift) / region.size_px
                   : 0;
    const float trust = std::clamp((kDiffers - apart) / (kDiffers - kAgrees), kLeastTrust, 1.0f);
    confidences[i] = estimate.presence * certainty * trust;
  }
  return confidences;
}

float mean_of(const Confidences& confidences) {
  return std::accumulate(confidences.begin(), confidences.end(), 0.0f) /
         static_cast<float>(confidences.size());
}

}  // namespace handcast::landmarks
