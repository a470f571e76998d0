// SPDX-License-Identifier: Apache-2.0
#include "services/tools/try/projected.hpp"

#include <utility>
#include <vector>

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/draw/cpu/nearest_pixel.hpp"

namespace handcast::trial {
namespace {

constexpr int kPadding_px = 4;

/// Continues what is drawn beyond its outline.
void pad(renderer::Texture& image) {
  renderer::Image<std::uint8_t> on(image.width(), image.height()), off = on;
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    on.pixels()[i] = image.pixels()[i] != 0;
    off.pixels()[i] = image.pixels()[i] == 0;
  }
  renderer::cpu::NearestPixel nearest;
  for (const auto& way :
       nearest.find(std::as_const(on).view(), std::as_const(off).view(), kPadding_px))
    image.at(way.x, way.y) = image.at(way.x + way.dx, way.y + way.dy);
}

}  // namespace

renderer::Texture projected(const content::HandState& hand, const renderer::Texture& picture,
                            const calib::Calibration& calibration) {
  const int width = calibration.projector.width_px, height = calibration.projector.height_px;
  const glm::mat4x3 from_camera(calibration.projection());
  std::vector<glm::vec2> position_px;
  std::vector<float> depth_m;
  for (const auto& at : hand.positions_m) {
    const glm::vec3 px = from_camera * glm::vec4(at, 1);
    position_px.push_back(glm::vec2(px) / px.z);
    depth_m.push_back(at.z);
  }
  const renderer::MipChain mips(picture, true);
  const renderer::DrawnHand drawn{.mesh = hand.mesh,
                                  .picture = mips.view(),
                                  .position_px = position_px,
                                  .depth_m = depth_m,
                                  .light = {}};
  const auto painter = renderer::make_cpu_painter(width, height);
  painter->draw({&drawn, 1}, {0, 0, width, height});
  const auto seen = painter->colour();
  renderer::Texture image(width, height);
  for (int y = 0; y < height; ++y) std::copy_n(seen.row(y), width, image.row(y));
  pad(image);
  return image;
}

}  // namespace handcast::trial
