// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::twin {

/// The point spread of a lens and its sensor: a Gaussian, cut off at three standard deviations.
/// Reuses its buffers: not thread-safe.
class PointSpread {
 public:
  /// `sigma_px`: standard deviation; 0 for a perfect lens.
  explicit PointSpread(double sigma_px);
  /// How far light spreads, px; 0 for a perfect lens.
  int reach_px() const { return static_cast<int>(weights_.size()) / 2; }
  /// Spreads the pixels of `region`, which must be inside `image`. What is beside the region
  /// counts as equal to its edge.
  void spread(renderer::View<float> image, const renderer::Rect& region);

 private:
  void spread_rows(renderer::View<float> image, const renderer::Rect& region);
  void spread_columns(renderer::View<float> image, const renderer::Rect& region);

  std::vector<float> weights_;         ///< from one end to the other
  std::vector<const float*> sources_;  ///< for each weight, the pixels that it belongs to
  std::vector<float> row_;
  renderer::Image<float> rows_;
};

}  // namespace handcast::twin
