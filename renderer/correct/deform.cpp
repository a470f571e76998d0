// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/deform.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "renderer/base/clones.hpp"

namespace handcast::renderer {
namespace {

constexpr int kChunk = 16;          ///< points moved at once
constexpr float kNear_px2 = 1e-4f;  ///< keeps the weight of a control point at itself finite
constexpr float kSpot_px = 0.5f;    ///< control points closer to their mean than this coincide
constexpr float kStandIn_px = 1000;
constexpr float kSpread_px2 = 1e-6f;  ///< keeps the division by the control points' spread finite

glm::vec2 mean(std::span<const glm::vec2> points) {
  glm::vec2 sum{0};
  for (const glm::vec2& point : points) sum += point;
  return sum / static_cast<float>(points.size());
}

/// Sixteen points at once; the compiler splits them over the registers of the processor.
using Lanes = float __attribute__((vector_size(4 * kChunk)));

enum class Power { half, one, any };

template <Power power>
inline __attribute__((always_inline)) void weigh(const Lanes& distance2, float alpha,
                                                 Lanes& weight) {
  if constexpr (power == Power::one) {
    weight = 1.0f / distance2;
  } else {
    for (int k = 0; k < kChunk; ++k)
      weight[k] =
          power == Power::half ? 1.0f / std::sqrt(distance2[k]) : std::pow(distance2[k], -alpha);
  }
}

/// Schaefer et al. 2006, equations 5 to 7, with all positions relative to the point v that is
/// moved: f(v) = q* + M (v - p*), M a similarity.
template <Power power>
inline __attribute__((always_inline)) void move_chunk(const glm::vec2* p, const glm::vec2* q,
                                                      int controls, float alpha, float* x,
                                                      float* y) {
  Lanes vx, vy;
  std::memcpy(&vx, x, sizeof vx);
  std::memcpy(&vy, y, sizeof vy);
  Lanes total{}, px_sum{}, py_sum{}, qx_sum{}, qy_sum{}, along{}, across{}, spread{};
  for (int i = 0; i < controls; ++i) {
    const Lanes px = p[i].x - vx, py = p[i].y - vy, qx = q[i].x - vx, qy = q[i].y - vy;
    const Lanes distance2 = px * px + py * py;
    Lanes w;
    weigh<power>(distance2 + kNear_px2, alpha, w);
    const Lanes wx = w * px, wy = w * py;
    total += w;
    px_sum += wx;
    py_sum += wy;
    qx_sum += w * qx;
    qy_sum += w * qy;
    along += wx * qx + wy * qy;
    across += wx * qy - wy * qx;
    spread += w * distance2;
  }
  const Lanes share = 1.0f / total;
  const Lanes px = px_sum * share, py = py_sum * share, qx = qx_sum * share, qy = qy_sum * share;
  const Lanes least = kSpread_px2 * total;
  const Lanes per_spread = 1.0f / (spread - (px_sum * px + py_sum * py) + least);
  const Lanes cosine = (along - (px_sum * qx + py_sum * qy) + least) * per_spread;
  const Lanes sine = (across - (px_sum * qy - py_sum * qx)) * per_spread;
  vx += qx - (cosine * px - sine * py);
  vy += qy - (sine * px + cosine * py);
  std::memcpy(x, &vx, sizeof vx);
  std::memcpy(y, &vy, sizeof vy);
}

HANDCAST_CLONES void move_chunk_half(const glm::vec2* p, const glm::vec2* q, int controls,
                                     float alpha, float* x, float* y) {
  move_chunk<Power::half>(p, q, controls, alpha, x, y);
}
HANDCAST_CLONES void move_chunk_one(const glm::vec2* p, const glm::vec2* q, int controls,
                                    float alpha, float* x, float* y) {
  move_chunk<Power::one>(p, q, controls, alpha, x, y);
}
void move_chunk_any(const glm::vec2* p, const glm::vec2* q, int controls, float alpha, float* x,
                    float* y) {
  move_chunk<Power::any>(p, q, controls, alpha, x, y);
}

}  // namespace

MovingLeastSquares::MovingLeastSquares(std::span<const glm::vec2> p, std::span<const glm::vec2> q,
                                       float alpha)
    : count_(p.size()), alpha_(alpha) {
  if (count_ > kMost || q.size() != count_) std::abort();
  std::ranges::copy(p, p_.begin());
  std::ranges::copy(q, q_.begin());
  if (count_ == 0) return;
  const glm::vec2 p_mean = mean(p), q_mean = mean(q);
  const bool on_one_spot = std::ranges::all_of(
      p, [&](glm::vec2 point) { return glm::distance(point, p_mean) < kSpot_px; });
  if (!on_one_spot) return;
  // Coinciding points do not determine rotation and scale. Two points that keep both replace them.
  count_ = 2;
  p_[0] = p_mean - glm::vec2(kStandIn_px, 0);
  p_[1] = p_mean + glm::vec2(kStandIn_px, 0);
  q_[0] = q_mean - glm::vec2(kStandIn_px, 0);
  q_[1] = q_mean + glm::vec2(kStandIn_px, 0);
}

glm::vec2 MovingLeastSquares::operator()(glm::vec2 v) const {
  apply({&v, 1});
  return v;
}

void MovingLeastSquares::apply(std::span<glm::vec2> points) const {
  if (count_ == 0) return;
  const auto move = alpha_ == 0.5f   ? move_chunk_half
                    : alpha_ == 1.0f ? move_chunk_one
                                     : move_chunk_any;
  alignas(64) float x[kChunk], y[kChunk];
  for (std::size_t first = 0; first < points.size(); first += kChunk) {
    const auto chunk = points.subspan(first, std::min<std::size_t>(kChunk, points.size() - first));
    for (std::size_t k = 0; k < kChunk; ++k) {
      const glm::vec2 v = chunk[std::min(k, chunk.size() - 1)];
      x[k] = v.x;
      y[k] = v.y;
    }
    move(p_.data(), q_.data(), static_cast<int>(count_), alpha_, x, y);
    for (std::size_t k = 0; k < chunk.size(); ++k) chunk[k] = {x[k], y[k]};
  }
}

}  // namespace handcast::renderer
