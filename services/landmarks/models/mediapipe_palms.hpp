// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "services/landmarks/geometry/region.hpp"

/// The output of MediaPipe Hands' palm network: single-shot detection relative to anchors.
namespace handcast::landmarks {

/// A palm in the square image that the network was given. Places and lengths are fractions of its
/// side, 0..1 from the upper left corner.
struct Palm {
  /// Wrist; knuckles of index, middle, ring and little finger; lowest joint and knuckle of the
  /// thumb.
  static constexpr int kPoints = 7;
  float score = 0;  ///< 0..1
  /// Its box.
  /// @{
  glm::vec2 centre{0}, extent{0};
  /// @}
  std::array<glm::vec2, kPoints> points{};  ///< its points
};

inline constexpr int kPalmSide_px = 192;                   ///< side of the network's input
inline constexpr int kPalmAnchors = 2016;                  ///< number of anchors
inline constexpr int kPalmValues = 4 + 2 * Palm::kPoints;  ///< values per anchor

/// The anchors: the centres of 24 x 24 cells, each twice, then of 12 x 12 cells, each six times.
std::span<const glm::vec2> palm_anchors();

/// Decodes the network's outputs: `boxes`, kPalmAnchors x kPalmValues, and `logits`, kPalmAnchors.
/// Candidates that overlap are merged, weighted by score (MediaPipe's weighted suppression). The
/// highest score comes first; none is below `least_score`.
std::vector<Palm> decode_palms(std::span<const float> boxes, std::span<const float> logits,
                               float least_score = 0.5f);

/// The region in which to estimate the landmarks of a palm that was found in the region `shown`.
Region region_of_palm(const Palm& palm, const Region& shown);

}  // namespace handcast::landmarks
