// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>

namespace handcast::renderer {

/// A similarity of the plane: rotation by an angle a, scale s, and translation.
///
///     v' = (cosine x - sine y, sine x + cosine y) + shift,  cosine = s cos a, sine = s sin a
struct Similarity {
  /// Cosine and sine of the angle, both times the scale.
  /// @{
  float cosine = 1, sine = 0;
  /// @}
  glm::vec2 shift{0};  ///< the image of the origin

  /// The image of `v`.
  glm::vec2 operator()(const glm::vec2& v) const {
    return glm::vec2(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y) + shift;
  }
};

/// The least-squares similarity that maps the points `p` onto the points `q`, of the same number.
/// Its scale is clamped to 1/2..2, which limits the effect of outliers. A translation if all `p`
/// coincide. `weight`: one number per point, with a sum above 0; empty: all are equal.
inline Similarity fit_similarity(std::span<const glm::vec2> p, std::span<const glm::vec2> q,
                                 std::span<const float> weight = {}) {
  constexpr float kLeastScale = 0.5f, kMostScale = 2.0f;
  const auto weight_of = [&](std::size_t i) { return weight.empty() ? 1.0f : weight[i]; };
  float total = 0;
  for (std::size_t i = 0; i < p.size(); ++i) total += weight_of(i);
  glm::vec2 p_mean{0}, q_mean{0};
  for (std::size_t i = 0; i < p.size(); ++i) {
    p_mean += weight_of(i) * p[i] / total;
    q_mean += weight_of(i) * q[i] / total;
  }
  float along = 0, across = 0, spread = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::vec2 a = p[i] - p_mean, b = weight_of(i) * (q[i] - q_mean);
    along += a.x * b.x + a.y * b.y;
    across += a.x * b.y - a.y * b.x;
    spread += weight_of(i) * (a.x * a.x + a.y * a.y);
  }
  Similarity fit;
  const float turned = std::hypot(along, across);
  if (spread > 1e-6f && turned > 1e-6f * spread) {
    const float scale = std::clamp(turned / spread, kLeastScale, kMostScale);
    fit.cosine = scale * along / turned;
    fit.sine = scale * across / turned;
  }
  fit.shift = q_mean - glm::vec2(fit.cosine * p_mean.x - fit.sine * p_mean.y,
                                 fit.sine * p_mean.x + fit.cosine * p_mean.y);
  return fit;
}

}  // namespace handcast::renderer
