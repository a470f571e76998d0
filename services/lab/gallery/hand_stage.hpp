// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/base/mip_chain.hpp"
#include "renderer/draw/painter.hpp"
#include "services/content/hands.hpp"

namespace handcast::gallery {

/// Draws hands that wear content, as an audience sees them: skin in dim light, and on it the light
/// of the content. One thread.
class HandStage {
 public:
  /// Pictures have the size of the projector of the calibration.
  explicit HandStage(const calib::Calibration& calibration);

  /// The hands that are there, with surfaces (Needs::surface), and what they wear, left and right.
  /// RGBA8, opaque. Valid until the next call.
  renderer::View<const std::uint32_t> take(const content::BothHands& hands,
                                           const std::array<const renderer::Texture*, 2>& worn);
  /// What contains both hands in the last picture; empty without hands.
  renderer::Rect region() const { return region_; }

 private:
  struct Placed {
    std::vector<glm::vec2> position_px;
    std::vector<float> depth_m, lambert;
  };
  void place(const content::HandState& hand, Placed& placed);
  std::vector<renderer::DrawnHand> drawn(const content::BothHands& hands) const;
  void compose(renderer::View<const std::uint32_t> shade);

  glm::mat4x3 projector_from_space_;
  std::unique_ptr<renderer::Painter> painter_;
  std::array<Placed, 2> placed_;
  renderer::Rect region_;
  renderer::Texture light_, picture_;
};

}  // namespace handcast::gallery
