// SPDX-License-Identifier: Apache-2.0
#include "services/content/unwrap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handcast::content {
namespace {

constexpr int kCoarse_px = 4;          ///< pixels of the picture per pixel of the depth buffer
constexpr float kBehind_m = 0.008f;    ///< that a texel may lie behind the nearest surface
constexpr float kLeastFacing = 0.15f;  ///< cosine of the angle of view, below which skin is smeared
constexpr float kNearest_m = 0.05f;    ///< what is nearer to the camera's plane is not seen

/// Where a viewer sees the vertices of a hand: px, and the distance from its centre, m.
struct SeenVertices {
  SeenVertices(const Viewer& viewer, std::span<const glm::vec3> positions_m) {
    for (const glm::vec3& at : positions_m) {
      px.push_back(at.z > kNearest_m ? viewer.pixel_of(at) : glm::vec2(-1e6f));
      distance_m.push_back(glm::distance(at, viewer.centre_m));
    }
  }
  std::vector<glm::vec2> px;
  std::vector<float> distance_m;
};

/// The distance of the nearest surface, in a picture of 1 / kCoarse_px.
class DepthBuffer {
 public:
  explicit DepthBuffer(const Viewer& viewer)
      : distance_m_(viewer.width_px / kCoarse_px + 1, viewer.height_px / kCoarse_px + 1,
                    std::numeric_limits<float>::max()) {}

  void draw(const renderer::HandMesh& mesh, const SeenVertices& seen) {
    for (const auto& [a, b, c] : mesh.triangles)
      fill({seen.px[a] / (1.f * kCoarse_px), seen.px[b] / (1.f * kCoarse_px),
            seen.px[c] / (1.f * kCoarse_px)},
           {seen.distance_m[a], seen.distance_m[b], seen.distance_m[c]});
  }
  bool hides(const glm::vec2& px, float distance_m) const {
    return distance_m > distance_m_.at(static_cast<int>(px.x / kCoarse_px + 0.5f),
                                       static_cast<int>(px.y / kCoarse_px + 0.5f)) +
                            kBehind_m;
  }

 private:
  void fill(const std::array<glm::vec2, 3>& at, const std::array<float, 3>& distance_m) {
    const glm::vec2 ab = at[1] - at[0], ac = at[2] - at[0];
    const float area = ab.x * ac.y - ab.y * ac.x;
    const glm::vec2 low = glm::min(at[0], glm::min(at[1], at[2])),
                    high = glm::max(at[0], glm::max(at[1], at[2]));
    const glm::vec2 size(distance_m_.width() - 1, distance_m_.height() - 1);
    if (std::abs(area) < 1e-9f || low.x > size.x || low.y > size.y || high.x < 0 || high.y < 0)
      return;
    const glm::ivec2 first(glm::ceil(glm::max(low, glm::vec2(0)))),
        last(glm::floor(glm::min(high, size)));
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const glm::vec2 way = glm::vec2(x, y) - at[0];
        const float v = (way.x * ac.y - way.y * ac.x) / area,
                    w = (ab.x * way.y - ab.y * way.x) / area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        const float distance = distance_m[0] * (1 - v - w) + distance_m[1] * v + distance_m[2] * w;
        distance_m_.at(x, y) = std::min(distance_m_.at(x, y), distance);
      }
  }

  renderer::Image<float> distance_m_;
};

}  // namespace

Viewer viewer_of(const calib::CameraModel& lens) {
  return {lens.width_px, lens.height_px, glm::vec3(0),
          [lens](const glm::vec3& at) { return glm::vec2(lens.distort(lens.project(at))); }};
}

Viewer viewer_of(const calib::Calibration& calibration) {
  const auto& projector = calibration.projector;
  const glm::mat4x3 from_camera(calibration.projection());
  return {projector.width_px, projector.height_px,
          glm::vec3(projector.centre_m(calibration.camera)), [from_camera](const glm::vec3& at) {
            const glm::vec3 px = from_camera * glm::vec4(at, 1);
            return glm::vec2(px) / px.z;
          }};
}

std::vector<SeenTexel> seen_texels(const Viewer& viewer, const SurfaceMap& map,
                                   const HandState& hand, const HandState* other) {
  std::vector<SeenTexel> seen;
  if (hand.positions_m.empty()) return seen;
  const SeenVertices vertices(viewer, hand.positions_m);
  DepthBuffer nearest(viewer);
  nearest.draw(*hand.mesh, vertices);
  if (other && !other->positions_m.empty())
    nearest.draw(*other->mesh, SeenVertices(viewer, other->positions_m));
  const glm::vec2 last(viewer.width_px - 1, viewer.height_px - 1);
  const auto texels = map.texels();
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const glm::vec3 way = texels[i].of(hand.positions_m) - viewer.centre_m;
    const float distance = glm::length(way);
    if (-glm::dot(way, texels[i].of(hand.normals)) < kLeastFacing * distance) continue;
    const glm::vec2 px = texels[i].of(std::span<const glm::vec2>(vertices.px));
    const bool is_inside = px.x >= 0 && px.y >= 0 && px.x <= last.x && px.y <= last.y;
    if (is_inside && !nearest.hides(px, distance)) seen.push_back({i, px});
  }
  return seen;
}

}  // namespace handcast::content
