// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "renderer/draw/painter.hpp"
#include "renderer/skin/hand_surface.hpp"
#include "tests/renderer/poses.hpp"

namespace handcast::bench {

/// Hands at the twin's distance on the reference rig, ready to be painted, and the mask of a camera
/// that sees them 12 px further.
class PainterScene {
 public:
  /// One hand (the left one) or two, 0.73 m from the camera. The hand files must exist.
  /// `smooth`: see MipLayout.
  PainterScene(std::string name, int hands, const renderer::samples::Pose& pose, int width_px,
               int height_px, bool smooth = true);

  std::string name;                        ///< e.g. "one hand, open"
  std::vector<renderer::DrawnHand> drawn;  ///< borrows from this object
  renderer::Image<std::uint8_t> mask;      ///< 255 hand, 0 not
  renderer::Rect region;                   ///< of drawing and mask
  renderer::WarpGrid grid;                 ///< 21 x 21 nodes over the screen, bent a little

 private:
  struct Hand {
    renderer::HandSurface surface;
    renderer::Skinned skinned;
    std::uint64_t revision = renderer::new_revision();
  };

  void place_hand(renderer::Side side, const renderer::samples::Pose& pose, float aside_m,
                  const calib::Calibration& calibration);
  void make_mask(int width_px, int height_px);

  renderer::MipChain picture_;
  std::vector<std::unique_ptr<Hand>> hands_;
};

}  // namespace handcast::bench
