// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "config/sections/twin/image.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/twin/random.hpp"

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

/// What the lens and the sensor of the twin's camera make of the light of a scene: point spread,
/// whole grey values, image faults and noise. Reuses its buffers: not thread-safe.
class ImageSensor {
 public:
  /// Copies the settings. `seed` selects the noise. `width_px`: of the images.
  ImageSensor(const config::TwinImage& settings, int seed, int width_px);

  /// How far light spreads, px.
  int reach_px() const { return spread_.reach_px(); }
  /// Sets what frames show outside their region: grey values before the point spread.
  void set_empty_scene(renderer::Image<float> greys);
  /// True once there is an empty scene, without which no frame can be developed.
  bool has_empty_scene() const { return !empty_scene_.pixels().empty(); }

  /// Makes frame `k`: the mean of `instants` images, whose grey values are added up in `region` of
  /// `sum`, and the empty scene elsewhere. Spreads the light of `sum` in place. `faulty`: with the
  /// faults of a row of pixels.
  void develop(std::uint64_t k, renderer::View<float> sum, const renderer::Rect& region,
               int instants, bool faulty, renderer::View<std::uint8_t> image);

 private:
  config::TwinImage settings_;
  Random random_;
  PointSpread spread_;
  renderer::Image<std::uint8_t> empty_scene_;  ///< empty at first
  std::vector<std::int8_t> noise_;  ///< each row of a frame reads it from a random offset
  std::vector<std::uint8_t> row_;
};

}  // namespace handcast::twin
