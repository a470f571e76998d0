// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/base/triangle.hpp"
#include "services/content/settable_source.hpp"
#include "services/content/surface_map.hpp"

namespace handcast::content {
namespace {

constexpr std::size_t kIndexTip = 10;
constexpr float kReach_m = 0.018f;  ///< from the tip to the skin that it draws on
constexpr float kDepth_m = 0.010f;  ///< how far trackers put a tip below the skin
constexpr float kLongest_mm = 60;   ///< of a line between two pictures; a longer one is two strokes
constexpr float kSameSide = -0.2f;  ///< cosine of the normals of texels that a brush reaches

/// Where the tip touches the hand, at rest.
struct Touch {
  glm::vec3 place_mm, normal;
};

/// Strokes that the index finger of the other hand draws on the skin. They are painted on the hand
/// at rest, so that a line goes on across the seams of the charts and a brush is as wide
/// everywhere.
class PaintSource final : public SettableSource {
 public:
  explicit PaintSource(const Opening& opening)
      : SettableSource(
            {plain_parameter("colour", "Colour", Parameter::Kind::colour, {1, 0.55, 0.1, 1}),
             number_parameter("size", "Width of the brush, mm", 1, 60, 8),
             number_parameter("fade", "Time until a stroke has gone, s; 0: it stays", 0, 600, 0),
             plain_parameter("clear", "Clear", Parameter::Kind::event, {0})}),
        hand_(*opening.meshes[static_cast<std::size_t>(opening.side)]),
        map_(surface_map_of(hand_, opening.width, opening.height)),
        places_mm_(rest_positions_mm(hand_)),
        normals_(rest_normals(hand_)),
        dry_(map_->texels().size(), glm::vec4(0)),
        wet_(map_->texels().size(), 0) {
    for (const SurfaceTexel& texel : map_->texels())
      at_rest_.push_back({texel.of<glm::vec3>(places_mm_), texel.of<glm::vec3>(normals_)});
  }

  Needs needs() const override { return {.surface = true}; }

  Result<void> set(std::string_view name, std::string_view value) override {
    dry();  // a stroke keeps the colour that it was begun with
    return SettableSource::set(name, value);
  }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    bool has_changed = moment.frame == 0;
    if (take_change() && number("clear") != 0) {
      set("clear", "false");
      take_change();
      std::ranges::fill(dry_, glm::vec4(0));
      has_changed = true;
    }
    has_changed = fade(moment.step_s) || has_changed;
    const auto touch = touch_of(*moment.hand, *moment.other);
    if (touch) has_changed = stroke(*touch) || has_changed;
    if (!touch) dry();
    last_ = touch;
    if (has_changed) show(out);
    return has_changed;
  }

 private:
  std::optional<Touch> touch_of(const HandState& hand, const HandState& other) const {
    if (!hand.is_there || !other.is_there || hand.positions_m.size() != places_mm_.size())
      return std::nullopt;
    const glm::vec3 tip = other.joints_m[kIndexTip];
    std::optional<Touch> touch;
    float nearest_m = kReach_m;
    for (const auto& [a, b, c] : hand_.triangles) {
      const auto& at = hand.positions_m;
      constexpr float kFar_m = 0.04f;  // longer than an edge and the reach
      if (std::abs(at[a].x - tip.x) > kFar_m || std::abs(at[a].y - tip.y) > kFar_m) continue;
      const glm::vec3 parts = renderer::nearest_in_triangle(tip, at[a], at[b], at[c]);
      const SurfaceTexel place{0, {a, b, c}, {parts.x, parts.y, parts.z}};
      const glm::vec3 way = tip - place.of(at);
      const float away_m = glm::length(way), above_m = glm::dot(way, place.of(hand.normals));
      if (!(away_m < nearest_m) || above_m < -kDepth_m) continue;
      nearest_m = away_m;
      touch = Touch{place.of<glm::vec3>(places_mm_), place.of<glm::vec3>(normals_)};
    }
    return touch;
  }

  /// Paints a line from the last touch. True if it covers a texel more than before.
  bool stroke(const Touch& touch) {
    const bool goes_on = last_ && glm::distance(last_->place_mm, touch.place_mm) < kLongest_mm;
    const glm::vec3 from = goes_on ? last_->place_mm : touch.place_mm,
                    along = touch.place_mm - from;
    const float length2 = std::max(glm::dot(along, along), 1e-6f),
                radius = static_cast<float>(number("size")) / 2;
    bool has_changed = false;
    for (std::size_t i = 0; i < at_rest_.size(); ++i) {
      const glm::vec3 way = at_rest_[i].place_mm - from;
      const float part = std::clamp(glm::dot(way, along) / length2, 0.f, 1.f);
      const glm::vec3 across = way - part * along;
      if (glm::dot(across, across) > radius * radius) continue;
      if (glm::dot(at_rest_[i].normal, touch.normal) < kSameSide) continue;
      const float cover = 1 - glm::smoothstep(0.6f * radius, radius, glm::length(across));
      if (cover <= wet_[i]) continue;
      wet_[i] = cover;
      has_changed = true;
    }
    is_wet_ = is_wet_ || has_changed;
    return has_changed;
  }

  /// A texel, premultiplied: the stroke that is drawn now over those before.
  glm::vec4 over(std::size_t i) const {
    const auto colour = numbers("colour");
    const float alpha = wet_[i] * static_cast<float>(colour[3]);
    const glm::vec4 brush(alpha * glm::vec3(colour[0], colour[1], colour[2]), alpha);
    return brush + dry_[i] * (1 - alpha);
  }

  /// Ends the stroke that is drawn now.
  void dry() {
    if (!std::exchange(is_wet_, false)) return;
    for (std::size_t i = 0; i < dry_.size(); ++i) {
      if (wet_[i] > 0) dry_[i] = over(i);
      wet_[i] = 0;
    }
  }

  /// Dry strokes get lighter: 2 % are left after the time. True if there were any.
  bool fade(double step_s) {
    const double fade_s = number("fade");
    if (fade_s <= 0) return false;
    const auto left = static_cast<float>(std::exp(-4 * step_s / fade_s));
    bool has_any = false;
    for (auto& texel : dry_) {
      if (texel.a <= 0) continue;
      has_any = true;
      texel = texel.a < 0.004f ? glm::vec4(0) : texel * left;
    }
    return has_any;
  }

  void show(renderer::Texture& out) const {
    const auto texels = map_->texels();
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const glm::vec4 colour = over(i);
      out.pixels()[texels[i].index] =
          colour.a > 0 ? texel_of({glm::vec3(colour) / colour.a, colour.a}) : 0;
    }
    map_->pad(out);
  }

  const renderer::HandMesh& hand_;
  std::shared_ptr<const SurfaceMap> map_;
  std::vector<glm::vec3> places_mm_, normals_;  ///< per vertex
  std::vector<Touch> at_rest_;                  ///< per texel of the map
  std::vector<glm::vec4> dry_;                  ///< per texel: ended strokes, premultiplied
  std::vector<float> wet_;                      ///< per texel: cover by the stroke of now
  bool is_wet_ = false;
  std::optional<Touch> last_;
};

}  // namespace

Result<std::unique_ptr<Source>> open_paint(const Opening& opening) {
  return std::make_unique<PaintSource>(opening);
}

}  // namespace handcast::content
