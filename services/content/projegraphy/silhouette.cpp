// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/silhouette.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace handcast::projegraphy {
namespace {

constexpr int kWristJoint = 1;
/// How much of the forearm belongs to the mask, and to the skin.
constexpr float kForearm_m = 0.03f, kSkinForearm_m = 0.1f;
constexpr float kMargin_px = 12;  ///< of the mask
constexpr float kFarthest_px = 1e5f;

/// Which vertices count: they belong to the hand and have a place that can be drawn.
std::vector<bool> counted_of(const FlatHand& hand, float forearm_m) {
  const glm::mat4 wrist_from_model = glm::inverse(hand.mesh->rest[kWristJoint]);
  std::vector<bool> counted(hand.px.size());
  for (std::size_t v = 0; v < counted.size(); ++v) {
    const glm::vec2 px = hand.px[v];
    counted[v] = (wrist_from_model * glm::vec4(hand.mesh->positions[v], 1)).z < forearm_m &&
                 std::abs(px.x) < kFarthest_px && std::abs(px.y) < kFarthest_px;
  }
  return counted;
}

void fill(const std::array<glm::vec2, 3>& at, renderer::Image<std::uint8_t>& mask) {
  const glm::vec2 ab = at[1] - at[0], ac = at[2] - at[0];
  const float area = ab.x * ac.y - ab.y * ac.x;
  if (std::abs(area) < 1e-6f) return;
  const glm::vec2 low = glm::min(at[0], glm::min(at[1], at[2])),
                  high = glm::max(at[0], glm::max(at[1], at[2]));
  const int y1 = std::min(kMaskSide_px - 1, static_cast<int>(std::floor(high.y))),
            x1 = std::min(kMaskSide_px - 1, static_cast<int>(std::floor(high.x)));
  constexpr float kSlack = -1e-4f;
  for (int y = std::max(0, static_cast<int>(std::ceil(low.y))); y <= y1; ++y)
    for (int x = std::max(0, static_cast<int>(std::ceil(low.x))); x <= x1; ++x) {
      const glm::vec2 way = glm::vec2(x, y) - at[0];
      const float v = (way.x * ac.y - way.y * ac.x) / area,
                  w = (ab.x * way.y - ab.y * way.x) / area;
      if (v >= kSlack && w >= kSlack && v + w <= 1 - kSlack) mask.at(x, y) = 1;
    }
}

/// Finds the frame of all hands.
void fit(std::span<const FlatHand> hands, Silhouette& silhouette) {
  glm::vec2 low(kFarthest_px), high(-kFarthest_px);
  for (const auto& hand : hands) {
    const auto counted = counted_of(hand, kSkinForearm_m);
    for (std::size_t v = 0; v < hand.px.size(); ++v) {
      if (!counted[v]) continue;
      low = glm::min(low, hand.px[v]);
      high = glm::max(high, hand.px[v]);
    }
  }
  const float longest = std::max(high.x - low.x, high.y - low.y);
  silhouette.scale = longest > 1 ? (kMaskSide_px - 1 - 2 * kMargin_px) / longest : 0;
  if (longest > 1)
    silhouette.origin_px = 0.5f * (low + high) - 0.5f * (kMaskSide_px - 1) / silhouette.scale;
}

void draw(const FlatHand& hand, float forearm_m, const Silhouette& frame,
          renderer::Image<std::uint8_t>& mask) {
  const auto counted = counted_of(hand, forearm_m);
  const auto at = [&](std::size_t v) { return frame.from_projector(hand.px[v]); };
  for (const auto& [a, b, c] : hand.mesh->triangles)
    if (counted[a] && counted[b] && counted[c]) fill({at(a), at(b), at(c)}, mask);
}

}  // namespace

Silhouette silhouette_of(std::span<const FlatHand> hands) {
  Silhouette silhouette;
  fit(hands, silhouette);
  if (silhouette.scale == 0) return silhouette;
  for (const auto& hand : hands) {
    draw(hand, kForearm_m, silhouette, silhouette.mask);
    draw(hand, kSkinForearm_m, silhouette, silhouette.skin);
  }
  silhouette.area_px =
      static_cast<int>(std::ranges::count(silhouette.mask.pixels(), std::uint8_t{1}));
  return silhouette;
}

float overlap_of(const Silhouette& a, const Silhouette& b) {
  int both = 0, any = 0;
  for (std::size_t i = 0; i < a.mask.pixels().size(); ++i) {
    both += a.mask.pixels()[i] & b.mask.pixels()[i];
    any += a.mask.pixels()[i] | b.mask.pixels()[i];
  }
  return any == 0 ? 0 : static_cast<float>(both) / static_cast<float>(any);
}

}  // namespace handcast::projegraphy
