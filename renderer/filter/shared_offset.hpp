// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "renderer/filter/landmark_filter.hpp"

namespace handcast::renderer {

/// How far off the detector says each landmark is, smoothed: standard deviation per axis in px, 0
/// where it does not say.
class LandmarkSigmas {
 public:
  void detection(const msg::HandLandmarks& seen);
  const std::array<float, kLandmarks>& px() const { return px_; }
  void forget() { *this = LandmarkSigmas(); }

 private:
  std::array<float, kLandmarks> px_{};
  std::array<bool, kLandmarks> known_{};
};

/// A tracker misplaces a hand more than the joints within it, so offsets lie near a similarity of
/// `tracker` (P). Draws each known one towards that, the more the larger its sigma is against how
/// far its finger's lie from there (empirical Bayes). One whose sigma is 0 stays.
void draw_together(std::array<glm::vec2, kLandmarks>& offsets_px,
                   const std::array<bool, kLandmarks>& known,
                   const std::array<float, kLandmarks>& sigma_px, const LandmarkPoints& tracker);

}  // namespace handcast::renderer
