// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "services/content/settable_source.hpp"
#include "services/content/surface_map.hpp"

namespace handcast::content {
namespace {

constexpr int kCoarse_px = 4;          ///< pixels of the image per pixel of the depth buffer
constexpr float kBehind_m = 0.008f;    ///< that a texel may lie behind the nearest surface
constexpr float kLeastFacing = 0.15f;  ///< cosine of the angle of view, below which skin is smeared

/// Where the camera sees the vertices of a hand: px of the image as the lens forms it.
std::vector<glm::vec2> project_all(const calib::CameraModel& lens,
                                   std::span<const glm::vec3> positions_m) {
  std::vector<glm::vec2> places;
  for (const glm::vec3& at : positions_m)
    places.push_back(at.z > 0.05f ? glm::vec2(lens.distort(lens.project(at))) : glm::vec2(-1e6f));
  return places;
}

/// The distance of the nearest surface along the camera's axis, in an image of 1 / kCoarse_px.
class DepthBuffer {
 public:
  explicit DepthBuffer(const renderer::GreyView& image)
      : depth_m_(image.width / kCoarse_px + 1, image.height / kCoarse_px + 1,
                 std::numeric_limits<float>::max()) {}

  void draw(const renderer::HandMesh& mesh, std::span<const glm::vec2> px,
            std::span<const glm::vec3> positions_m) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::array at{px[a] / (1.f * kCoarse_px), px[b] / (1.f * kCoarse_px),
                          px[c] / (1.f * kCoarse_px)};
      const std::array depth{positions_m[a].z, positions_m[b].z, positions_m[c].z};
      fill(at, depth);
    }
  }
  bool hides(const glm::vec2& px, float depth_m) const {
    return depth_m > depth_m_.at(static_cast<int>(px.x / kCoarse_px + 0.5f),
                                 static_cast<int>(px.y / kCoarse_px + 0.5f)) +
                         kBehind_m;
  }

 private:
  void fill(const std::array<glm::vec2, 3>& at, const std::array<float, 3>& depth_m) {
    const glm::vec2 ab = at[1] - at[0], ac = at[2] - at[0];
    const float area = ab.x * ac.y - ab.y * ac.x;
    const glm::vec2 low = glm::min(at[0], glm::min(at[1], at[2])),
                    high = glm::max(at[0], glm::max(at[1], at[2]));
    const glm::vec2 size(depth_m_.width() - 1, depth_m_.height() - 1);
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
        const float depth = depth_m[0] * (1 - v - w) + depth_m[1] * v + depth_m[2] * w;
        depth_m_.at(x, y) = std::min(depth_m_.at(x, y), depth);
      }
  }

  renderer::Image<float> depth_m_;
};

/// The level of an image at a place inside it, interpolated linearly.
float level_at(const renderer::GreyView& image, const glm::vec2& px) {
  const int x = std::min(static_cast<int>(px.x), image.width - 2),
            y = std::min(static_cast<int>(px.y), image.height - 2);
  const glm::vec2 part = px - glm::vec2(x, y);
  const auto* row = image.row(y) + x;
  const auto* below = image.row(y + 1) + x;
  return std::lerp(std::lerp(static_cast<float>(row[0]), static_cast<float>(row[1]), part.x),
                   std::lerp(static_cast<float>(below[0]), static_cast<float>(below[1]), part.x),
                   part.y);
}

/// What the camera sees of the hand, unwrapped. Where the hand is hidden, what was seen there last;
/// transparent where it was never seen.
class HandSource final : public SettableSource {
 public:
  explicit HandSource(const Opening& opening)
      : SettableSource(
            {plain_parameter("colour", "Colour of white", Parameter::Kind::colour, {1, 1, 1, 1}),
             number_parameter("gain", "Factor of the camera's levels", 0, 10, 1)}),
        map_(*opening.meshes[static_cast<std::size_t>(opening.side)], opening.width,
             opening.height),
        levels_(map_.texels().size(), kNeverSeen) {}

  Needs needs() const override { return {.surface = true, .camera = true}; }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    bool has_changed = take_change() || moment.frame == 0;
    const CameraView* view = moment.camera;
    if (view && view->image && view->image.id != last_id_) {
      last_id_ = view->image.id;
      has_changed = look(*view) || has_changed;
    }
    if (has_changed) show(out);
    return has_changed;
  }

 private:
  static constexpr float kNeverSeen = -1;

  /// Takes the levels of all texels that the camera sees. False if there are none.
  bool look(const CameraView& view) {
    const HandState& hand = *view.hand;
    const auto& image = view.image.view;
    if (hand.positions_m.empty() || image.width < 2 || image.height < 2) return false;
    const auto px = project_all(*view.lens, hand.positions_m);
    DepthBuffer nearest(image);
    nearest.draw(*hand.mesh, px, hand.positions_m);
    if (view.other && !view.other->positions_m.empty())
      nearest.draw(*view.other->mesh, project_all(*view.lens, view.other->positions_m),
                   view.other->positions_m);
    bool has_seen = false;
    const auto texels = map_.texels();
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const glm::vec3 at = texels[i].of(hand.positions_m), normal = texels[i].of(hand.normals);
      if (-glm::dot(at, normal) < kLeastFacing * glm::length(at)) continue;
      const glm::vec2 place = texels[i].of(std::span<const glm::vec2>(px));
      const bool is_inside = place.x >= 0 && place.y >= 0 && place.x <= image.width - 1.f &&
                             place.y <= image.height - 1.f;
      if (!is_inside || nearest.hides(place, at.z)) continue;
      levels_[i] = level_at(image, place);
      has_seen = true;
    }
    return has_seen;
  }

  void show(renderer::Texture& out) const {
    const auto tint = numbers("colour");
    const auto gain = static_cast<float>(number("gain")) / 255;
    const auto texels = map_.texels();
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const float level = levels_[i] * gain;
      const glm::vec4 colour(level * glm::vec3(tint[0], tint[1], tint[2]), tint[3]);
      out.pixels()[texels[i].index] = levels_[i] == kNeverSeen ? 0 : texel_of(colour);
    }
    map_.pad(out);
  }

  SurfaceMap map_;
  std::vector<float> levels_;  ///< per texel of the map, 0..255
  std::uint64_t last_id_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace

Result<std::unique_ptr<Source>> open_hand(const Opening& opening) {
  return std::make_unique<HandSource>(opening);
}

}  // namespace handcast::content
