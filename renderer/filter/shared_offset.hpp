// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "renderer/filter/landmark_filter.hpp"

namespace handcast::renderer {

/// The standard deviation that the detector reports for each landmark, smoothed over the
/// detections.
class LandmarkSigmas {
 public:
  /// Adds a detection. Landmarks that were not seen keep their value.
  void detection(const msg::HandLandmarks& seen);
  /// Standard deviations per axis, camera px; 0 if the detector reports none.
  const std::array<float, kLandmarks>& px() const { return px_; }
  /// Drops all detections.
  void forget() { *this = LandmarkSigmas(); }

 private:
  std::array<float, kLandmarks> px_{};
  std::array<bool, kLandmarks> known_{};
};

/// Shrinks the offsets Q - P towards the offsets of one similarity of `tracker` (P), because a
/// tracker misplaces the whole hand more than the joints in it. A known offset is moved the more,
/// the larger its sigma is compared with the spread of its finger's offsets about the similarity
/// (empirical Bayes). An offset whose sigma is 0 is not moved.
void shrink_to_shared(std::array<glm::vec2, kLandmarks>& offsets_px,
                      const std::array<bool, kLandmarks>& known,
                      const std::array<float, kLandmarks>& sigma_px, const LandmarkPoints& tracker);

}  // namespace handcast::renderer
