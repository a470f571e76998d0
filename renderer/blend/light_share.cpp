// SPDX-License-Identifier: Apache-2.0
#include "renderer/blend/light_share.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ipc/msg/projection.hpp"
#include "renderer/base/srgb.hpp"

namespace handcast::renderer {
namespace {

constexpr float kNowhere_m = std::numeric_limits<float>::max();
/// Width of a cell of the map of depths, on a hand at plane_m: wider than the distance of two
/// vertices, and narrower than a finger.
constexpr double kCell_mm = 6;
/// A shadow is looked for this many cells around a vertex, so that a light ends gently before its
/// shadow begins.
constexpr int kAround = 1;
/// A part of the hand that is nearer by this much casts a shadow: less than a finger's thickness,
/// and more than a slope changes within kAround cells.
constexpr float kShadow_m = 0.012f;
/// Before the border of its image a light fades out within this part of the height.
constexpr float kBorder = 0.05f;

float power4(float x) { return x * x * x * x; }

int cell_px_of(const calib::Calibration& calibration) {
  const double mm = calibration.mm_per_projector_px(calibration.projector.plane_m);
  return static_cast<int>(std::lround(std::clamp(kCell_mm / mm, 1.0, 100.0)));
}

}  // namespace

LightShare::Beam::Beam(const calib::Calibration& calibration)
    : projection(calibration.projection()),
      centre_m(calibration.projector.centre_m(calibration.camera)),
      width_px(static_cast<float>(calibration.projector.width_px)),
      height_px(static_cast<float>(calibration.projector.height_px)),
      cell_px(cell_px_of(calibration)),
      nearest_m(calibration.projector.width_px / cell_px + 1,
                calibration.projector.height_px / cell_px + 1) {}

/// Pixel and depth of a point.
glm::vec3 LightShare::Beam::seen(const glm::vec3& point_m) const {
  const glm::vec3 p = projection * glm::vec4(point_m, 1);
  return {glm::vec2(p) / p.z, p.z};
}

/// Enters the vertices of a hand into the map of depths.
void LightShare::Beam::meet(const Hand& hand, std::vector<glm::vec3>& seen_px) {
  const auto count = hand.position_m.size();
  if (seen_px.size() < count) seen_px.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    const glm::vec3 at = seen_px[v] = seen(hand.position_m[v]);
    // Written so that coordinates that are not finite leave the vertex out.
    if (!(at.z > 0 && at.x >= 0 && at.y >= 0 && at.x < width_px && at.y < height_px)) continue;
    auto& nearest =
        nearest_m.at(static_cast<int>(at.x) / cell_px, static_cast<int>(at.y) / cell_px);
    nearest = std::min(nearest, at.z);
  }
}

/// 1 where nothing near casts a shadow, 0 from the edge of a shadow on.
float LightShare::Beam::lit_part(const glm::vec3& seen) const {
  const int column = static_cast<int>(seen.x) / cell_px, row = static_cast<int>(seen.y) / cell_px;
  const Rect around =
      Rect{column - kAround, row - kAround, column + kAround + 1, row + kAround + 1}.within(
          nearest_m.width(), nearest_m.height());
  int shadowed = 0;
  for (int y = around.y0; y < around.y1; ++y)
    for (int x = around.x0; x < around.x1; ++x) shadowed += nearest_m.at(x, y) < seen.z - kShadow_m;
  constexpr float kHalf = 0.5f * (2 * kAround + 1) * (2 * kAround + 1);
  return std::max(0.0f, 1 - static_cast<float>(shadowed) / kHalf);
}

/// How well the light falls on a vertex: 0 if not at all.
float LightShare::Beam::quality(const glm::vec3& seen, const glm::vec3& point_m,
                                const glm::vec3& normal) const {
  const float border_px = std::min({seen.x, width_px - 1 - seen.x, seen.y, height_px - 1 - seen.y});
  if (!(border_px > 0)) return 0;
  const float cosine = glm::dot(normal, glm::normalize(centre_m - point_m));
  if (!(cosine > 0)) return 0;
  return power4(cosine) * lit_part(seen) * std::min(1.0f, border_px / (kBorder * height_px));
}

LightShare::LightShare(const calib::Calibration& calibration)
    : beams_{Beam(calibration), Beam(calib::at_projector(calibration, config::Viewpoint::second))} {
  // A hand that comes later finds its memory touched.
  for (auto& hand : seen_) hand.fill(std::vector<glm::vec3>(msg::kMaxVertices));
}

void LightShare::apply(std::span<const Hand> hands, float beside) {
  for (std::size_t b = 0; b < beams_.size(); ++b) {
    auto& nearest_m = beams_[b].nearest_m;
    std::fill_n(nearest_m.row(0), nearest_m.width() * nearest_m.height(), kNowhere_m);
    for (std::size_t h = 0; h < hands.size(); ++h) beams_[b].meet(hands[h], seen_[h][b]);
  }
  constexpr float kLeast = 1e-4f;  // what neither light reaches is drawn by both
  for (std::size_t h = 0; h < hands.size(); ++h) {
    const auto& [position_m, normal, light] = hands[h];
    for (std::size_t v = 0; v < light.size(); ++v) {
      const float own = beams_[0].quality(seen_[h][0][v], position_m[v], normal[v]) + kLeast,
                  other = beams_[1].quality(seen_[h][1][v], position_m[v], normal[v]);
      light[v] *= fast_srgb_level(own / (own + beside * other));
    }
  }
}

}  // namespace handcast::renderer
