// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "renderer/draw/cpu/cpu_painter.hpp"

namespace handcast::bench {

/// A stand-in for a posed hand seen by a 1024x768 projector: six closed capsules (palm, thumb,
/// fingers) with about as many triangles and lit pixels as the real one. Needs no hand file.
class CapsuleHand {
 public:
  explicit CapsuleHand(glm::vec2 wrist_px = {512, 480}, float scale = 1)
      : wrist_px_(wrist_px), scale_(scale), texture_(1024, 640) {
    add({0, 60}, {0, -10}, 78);
    add({55, 60}, {140, -10}, 19);
    add({-62, -10}, {-90, -135}, 16);
    add({-24, -30}, {-32, -175}, 17);
    add({19, -30}, {26, -180}, 17);
    add({58, -20}, {82, -150}, 16);
    for (int y = 0; y < texture_.height(); ++y) {
      for (int x = 0; x < texture_.width(); ++x)
        texture_.at(x, y) =
            0xff000000u | static_cast<std::uint32_t>(x * 65'793 + y * 2'777) % 0xffffffu;
    }
  }

  renderer::DrawnHand drawn() const { return {&mesh_, &texture_, position_px_, depth_m_, light_}; }
  void shift(glm::vec2 by_px) {
    for (glm::vec2& position : position_px_) position += by_px;
  }
  renderer::Rect bounds() const {
    glm::vec2 low = position_px_.front(), high = low;
    for (const glm::vec2& position : position_px_)
      low = glm::min(low, position), high = glm::max(high, position);
    return {static_cast<int>(low.x) - 1, static_cast<int>(low.y) - 1, static_cast<int>(high.x) + 2,
            static_cast<int>(high.y) + 2};
  }

 private:
  static constexpr int kRings = 18, kSegments = 19;

  /// Ring `ring` of 0..kRings - 1 from pole to pole: (way along the axis in px from `from`, radius
  /// in px).
  static glm::vec2 profile(int ring, float length, float radius) {
    constexpr int kCap = 4;
    const float quarter = std::numbers::pi_v<float> / 2;
    if (ring <= kCap)
      return {-radius * std::cos(quarter * ring / kCap), radius * std::sin(quarter * ring / kCap)};
    const int last = kRings - 1;
    if (ring >= last - kCap)
      return {length + radius * std::cos(quarter * (last - ring) / kCap),
              radius * std::sin(quarter * (last - ring) / kCap)};
    return {length * (ring - kCap) / (last - 2 * kCap), radius};
  }

  void add(glm::vec2 from, glm::vec2 to, float radius) {
    constexpr float kMetresPerPx = 0.00055f;
    const auto base = static_cast<int>(mesh_.positions.size());
    const glm::vec2 axis = glm::normalize(to - from), across{-axis.y, axis.x};
    const float length = glm::length(to - from),
                part = static_cast<float>(base) / (6 * kRings * (kSegments + 1));
    for (int ring = 0; ring < kRings; ++ring) {
      for (int segment = 0; segment <= kSegments; ++segment) {
        const float angle = 2 * std::numbers::pi_v<float> * segment / kSegments;
        const glm::vec2 at = profile(ring, length, radius);
        const glm::vec2 px =
            wrist_px_ + scale_ * (from + axis * at.x + across * (at.y * std::cos(angle)));
        const float rise_m = at.y * std::sin(angle) * kMetresPerPx * scale_;
        position_px_.push_back(px);
        depth_m_.push_back(0.6f - rise_m);
        light_.push_back(0.7f + 0.3f * std::sin(angle));
        mesh_.positions.emplace_back(px * kMetresPerPx, -rise_m);
        mesh_.uv.emplace_back(part + static_cast<float>(segment) / kSegments / 6,
                              static_cast<float>(ring) / (kRings - 1));
        mesh_.chart.push_back(1);
      }
    }
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      for (int segment = 0; segment < kSegments; ++segment)
        add_quad(base + ring * (kSegments + 1) + segment);
    }
  }

  void add_quad(int corner) {
    const auto index = [&](int ring, int segment) {
      return static_cast<std::uint16_t>(corner + ring * (kSegments + 1) + segment);
    };
    mesh_.triangles.push_back({index(0, 0), index(0, 1), index(1, 0)});
    mesh_.triangles.push_back({index(0, 1), index(1, 1), index(1, 0)});
  }

  glm::vec2 wrist_px_;
  float scale_;
  renderer::HandMesh mesh_;
  renderer::Texture texture_;
  std::vector<glm::vec2> position_px_;
  std::vector<float> depth_m_, light_;
};

/// The silhouette a camera would give of a drawn hand: 255 hand, 0 not.
inline renderer::Image<std::uint8_t> silhouette(const CapsuleHand& hand, int width_px = 1024,
                                                int height_px = 768) {
  const auto painter = renderer::make_cpu_painter(width_px, height_px);
  const renderer::DrawnHand drawn = hand.drawn();
  painter->draw({&drawn, 1}, {0, 0, width_px, height_px});
  renderer::Image<std::uint8_t> mask(width_px, height_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) mask.at(x, y) = painter->surface().at(x, y) ? 255 : 0;
  }
  return mask;
}

}  // namespace handcast::bench
