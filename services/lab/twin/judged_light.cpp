// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/judged_light.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/srgb.hpp"

namespace handcast::twin {

static int least_alpha_at(float presence) {
  const double light = renderer::srgb_light(std::clamp(presence, 0.0f, 1.0f));
  return light >= 0.5 ? static_cast<int>(std::ceil(127.5 / light)) : 256;
}

JudgedLight::JudgedLight(const msg::Projection& projection)
    : projection_(projection),
      region_{projection.region_x_px, projection.region_y_px,
              projection.region_x_px + static_cast<int>(projection.region_width_px),
              projection.region_y_px + static_cast<int>(projection.region_height_px)} {
  for (std::uint32_t i = 0; i < hand_count(); ++i)
    least_alpha_[static_cast<std::size_t>(projection.hands[i].side)] =
        least_alpha_at(projection.hands[i].presence);
}

std::uint32_t JudgedLight::hand_count() const {
  return std::min<std::uint32_t>(projection_.hand_count,
                                 static_cast<std::uint32_t>(projection_.hands.size()));
}

glm::vec3 JudgedLight::colour_at(int x, int y) const {
  glm::vec3 light(0);
  if (x < region_.x0 || x >= region_.x1 || y < region_.y0 || y >= region_.y1) return light;
  const std::uint32_t pixel =
      projection_
          .pixels()[static_cast<std::ptrdiff_t>(y - region_.y0) * region_.width() + x - region_.x0];
  if (pixel >> 24 == 0) return light;
  for (int c = 0; c < 3; ++c)
    light[c] = static_cast<float>(renderer::srgb_light((pixel >> (8 * c) & 0xff) / 255.0));
  return light;
}

void JudgedLight::row(int y, int x0, int x1, std::uint8_t* alpha) const {
  std::fill(alpha + x0, alpha + x1, std::uint8_t{0});
  if (y < region_.y0 || y >= region_.y1) return;
  const std::uint32_t* pixels = projection_.pixels() +
                                static_cast<std::ptrdiff_t>(y - region_.y0) * region_.width() -
                                region_.x0;
  for (int x = std::max(x0, region_.x0); x < std::min(x1, region_.x1); ++x)
    alpha[x] = static_cast<std::uint8_t>(pixels[x] >> 24);
}

std::optional<JudgedLight::Shown> JudgedLight::shown(int x, int y) const {
  if (projection_.has_shown == 0 || x < region_.x0 || x >= region_.x1 || y < region_.y0 ||
      y >= region_.y1)
    return std::nullopt;
  const msg::ShownPoint& point = projection_.shown(x, y);
  if (point.hand == 0 || point.hand > hand_count()) return std::nullopt;
  return Shown{projection_.hands[point.hand - 1].side, glm::vec2(point.u, point.v) / 65535.0f};
}

}  // namespace handcast::twin
