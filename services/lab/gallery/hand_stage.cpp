// SPDX-License-Identifier: Apache-2.0
#include "services/lab/gallery/hand_stage.hpp"

#include <algorithm>

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "services/lab/gallery/lit_skin.hpp"

namespace handcast::gallery {
namespace {

using renderer::Rect;

Rect bounds_of(const std::vector<glm::vec2>& points) {
  glm::vec2 low(1e9f), high(-1e9f);
  for (const auto& point : points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  return {static_cast<int>(low.x) - 1, static_cast<int>(low.y) - 1, static_cast<int>(high.x) + 2,
          static_cast<int>(high.y) + 2};
}

}  // namespace

HandStage::HandStage(const calib::Calibration& calibration)
    : projector_from_space_(calibration.projection()),
      painter_(renderer::make_cpu_painter(calibration.projector.width_px,
                                          calibration.projector.height_px)),
      light_(calibration.projector.width_px, calibration.projector.height_px),
      picture_(calibration.projector.width_px, calibration.projector.height_px) {}

void HandStage::place(const content::HandState& hand, Placed& placed) {
  const auto count = hand.positions_m.size();
  placed.position_px.resize(count);
  placed.depth_m.resize(count);
  placed.lambert.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    const glm::vec3 at = hand.positions_m[v], px = projector_from_space_ * glm::vec4(at, 1);
    placed.position_px[v] = glm::vec2(px) / px.z;
    placed.depth_m[v] = at.z;
    placed.lambert[v] = std::clamp(-glm::dot(hand.normals[v], glm::normalize(at)), 0.05f, 1.f);
  }
  region_ = region_.joined(bounds_of(placed.position_px));
}

std::vector<renderer::DrawnHand> HandStage::drawn(const content::BothHands& hands) const {
  std::vector<renderer::DrawnHand> all;
  for (std::size_t i = 0; i < hands.size(); ++i)
    if (hands[i].is_there)
      all.push_back({.mesh = hands[i].mesh,
                     .position_px = placed_[i].position_px,
                     .depth_m = placed_[i].depth_m});
  return all;
}

void HandStage::compose(renderer::View<const std::uint32_t> shade) {
  for (int y = 0; y < picture_.height(); ++y)
    for (int x = 0; x < picture_.width(); ++x) {
      const bool is_inside = x >= region_.x0 && x < region_.x1 && y >= region_.y0 && y < region_.y1;
      const bool is_skin = is_inside && (shade.at(x, y) >> 24) != 0;
      picture_.at(x, y) = is_skin ? lit_skin(shade.at(x, y) & 0xff, light_.at(x, y)) : kNight;
    }
}

renderer::View<const std::uint32_t> HandStage::take(
    const content::BothHands& hands, const std::array<const renderer::Texture*, 2>& worn) {
  region_ = {};
  for (std::size_t i = 0; i < hands.size(); ++i)
    if (hands[i].is_there) place(hands[i], placed_[i]);
  region_ = region_.within(picture_.width(), picture_.height());
  if (region_.empty()) {
    std::ranges::fill(picture_.pixels(), kNight);
    return picture_.view();
  }
  auto all = drawn(hands);
  std::vector<renderer::MipChain> chains;
  for (std::size_t i = 0; i < hands.size(); ++i)
    if (hands[i].is_there) chains.emplace_back(*worn[i], true);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].picture = chains[i].view();
  painter_->draw(all, region_);
  const auto colour = painter_->colour();
  for (int y = region_.y0; y < region_.y1; ++y)
    std::copy_n(colour.row(y) + region_.x0, region_.width(), light_.row(y) + region_.x0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < hands.size(); ++i)
    if (hands[i].is_there) {
      all[next].picture = {};
      all[next++].light = placed_[i].lambert;
    }
  painter_->draw(all, region_);
  compose(painter_->colour());
  return picture_.view();
}

}  // namespace handcast::gallery
