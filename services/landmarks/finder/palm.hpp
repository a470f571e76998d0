// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "services/landmarks/finder/region.hpp"

namespace handcast::landmarks {

/// A palm as MediaPipe's palm network sees it; lengths and places in parts of the square it was
/// shown, 0..1 from its upper left corner.
struct Palm {
  static constexpr int kPoints =
      7;  ///< wrist; index, middle, ring, little knuckle; thumb's lowest joint and knuckle
  float score = 0;  ///< 0..1
  glm::vec2 centre{0}, extent{0};
  std::array<glm::vec2, kPoints> points{};
};

inline constexpr int kPalmSide_px = 192, kPalmAnchors = 2016, kPalmValues = 4 + 2 * Palm::kPoints;

/// The middles of the cells that the network's answers are relative to: 24 x 24 cells twice, then
/// 12 x 12 six times.
std::span<const glm::vec2> palm_anchors();

/// `boxes`: kPalmAnchors x kPalmValues, `logits`: kPalmAnchors, as the network gives them.
/// Candidates that overlap become one, the mean weighted by score (MediaPipe's weighted
/// suppression). The best first, none below `least_score`.
std::vector<Palm> decode_palms(std::span<const float> boxes, std::span<const float> logits,
                               float least_score = 0.5f);

/// Where to look for the landmarks of a palm seen in `shown`.
Region region_of_palm(const Palm& palm, const Region& shown);

}  // namespace handcast::landmarks
