// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "services/content/settable_source.hpp"
#include "services/content/unwrap.hpp"

namespace handcast::content {
namespace {

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
        map_(surface_map_of(*opening.meshes[static_cast<std::size_t>(opening.side)], opening.width,
                            opening.height)),
        levels_(map_->texels().size(), kNeverSeen) {}

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
    const auto& image = view.image.view;
    if (image.width < 2 || image.height < 2) return false;
    auto camera = viewer_of(*view.lens);
    camera.width_px = image.width;
    camera.height_px = image.height;
    const auto seen = seen_texels(camera, *map_, *view.hand, view.other);
    for (const auto& [which, px] : seen) levels_[which] = level_at(image, px);
    return !seen.empty();
  }

  void show(renderer::Texture& out) const {
    const auto tint = numbers("colour");
    const auto gain = static_cast<float>(number("gain")) / 255;
    const auto texels = map_->texels();
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const float level = levels_[i] * gain;
      const glm::vec4 colour(level * glm::vec3(tint[0], tint[1], tint[2]), tint[3]);
      out.pixels()[texels[i].index] = levels_[i] == kNeverSeen ? 0 : texel_of(colour);
    }
    map_->pad(out);
  }

  std::shared_ptr<const SurfaceMap> map_;
  std::vector<float> levels_;  ///< per texel of the map, 0..255
  std::uint64_t last_id_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace

Result<std::unique_ptr<Source>> open_hand(const Opening& opening) {
  return std::make_unique<HandSource>(opening);
}

}  // namespace handcast::content
