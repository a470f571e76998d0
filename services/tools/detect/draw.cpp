// SPDX-License-Identifier: Apache-2.0
#include "services/tools/detect/draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace handcast::detect {
namespace {

using Colour = std::uint32_t;  ///< RGBA8, red in the lowest byte
constexpr Colour rgb(unsigned red, unsigned green, unsigned blue) {
  return red | green << 8 | blue << 16 | 0xff000000u;
}

constexpr std::array kFingerColours{rgb(255, 196, 0), rgb(0, 220, 120), rgb(0, 200, 255),
                                    rgb(150, 120, 255), rgb(255, 90, 160)};
constexpr Colour kWrist = rgb(255, 255, 255), kRegion = rgb(90, 140, 90),
                 kTracker = rgb(230, 80, 60);
constexpr double kBrightest = 0.998;  ///< fraction of the pixels that stay below white

void dot(renderer::Texture& picture, glm::vec2 at, float radius, Colour colour) {
  if (!(std::abs(at.x) < 1e5f && std::abs(at.y) < 1e5f)) return;
  const auto reach = static_cast<int>(std::ceil(radius));
  const int cx = static_cast<int>(std::lround(at.x)), cy = static_cast<int>(std::lround(at.y));
  for (int y = std::max(cy - reach, 0); y <= std::min(cy + reach, picture.height() - 1); ++y)
    for (int x = std::max(cx - reach, 0); x <= std::min(cx + reach, picture.width() - 1); ++x)
      if (glm::distance(at, glm::vec2(x, y)) <= radius) picture.at(x, y) = colour;
}

void line(renderer::Texture& picture, glm::vec2 from, glm::vec2 to, float radius, Colour colour) {
  const int steps = std::clamp(static_cast<int>(std::ceil(glm::distance(from, to))), 1, 20000);
  for (int i = 0; i <= steps; ++i)
    dot(picture, glm::mix(from, to, static_cast<float>(i) / static_cast<float>(steps)), radius,
        colour);
}

renderer::Texture brightened(renderer::GreyView grey) {
  std::array<std::size_t, 256> histogram{};
  for (int y = 0; y < grey.height; ++y)
    for (int x = 0; x < grey.width; ++x) ++histogram[grey.at(x, y)];
  const double most = kBrightest * grey.width * grey.height;
  double below = 0;
  int white = 0;
  while (white < 255 && (below += static_cast<double>(histogram[white])) < most) ++white;
  renderer::Texture picture(grey.width, grey.height);
  for (int y = 0; y < grey.height; ++y)
    for (int x = 0; x < grey.width; ++x) {
      const unsigned value =
          std::min(255u, grey.at(x, y) * 255u / static_cast<unsigned>(std::max(white, 16)));
      picture.at(x, y) = rgb(value, value, value);
    }
  return picture;
}

void draw_region(renderer::Texture& picture, const landmarks::Region& region, float pen) {
  const std::array<glm::vec2, 5> corners{{{-.5, -.5}, {.5, -.5}, {.5, .5}, {-.5, .5}, {-.5, -.5}}};
  for (int i = 0; i < 4; ++i)
    line(picture, region.to_image(corners[i]), region.to_image(corners[i + 1]),
         i == 0 ? 1.6f * pen : 0.6f * pen, kRegion);
}

void draw_hand(renderer::Texture& picture, const landmarks::Points& points, float pen) {
  for (int finger = 0; finger < 5; ++finger)
    for (int k = 1; k <= 4; ++k)
      line(picture, points[k == 1 ? 0 : 4 * finger + k - 1], points[4 * finger + k], 0.8f * pen,
           kFingerColours[finger]);
  for (int finger = 0; finger < 5; ++finger)
    for (int k = 1; k <= 4; ++k)
      dot(picture, points[4 * finger + k], 2.2f * pen, kFingerColours[finger]);
  dot(picture, points[0], 2.6f * pen, kWrist);
}

void draw_cross(renderer::Texture& picture, glm::vec2 at, float reach, float pen) {
  line(picture, at + glm::vec2(-reach, -reach), at + glm::vec2(reach, reach), pen, kTracker);
  line(picture, at + glm::vec2(-reach, reach), at + glm::vec2(reach, -reach), pen, kTracker);
}

}  // namespace

renderer::Texture draw(renderer::GreyView grey, std::span<const landmarks::FoundHand> hands,
                       const landmarks::Hints& hints_px) {
  renderer::Texture picture = brightened(grey);
  const float pen = std::max(1.0f, static_cast<float>(grey.width) / 800);
  for (const auto& hint : hints_px)
    for (std::size_t i = 0; hint && i < hint->size(); ++i)
      draw_cross(picture, (*hint)[i], 3 * pen, 0.6f * pen);
  for (const auto& hand : hands) draw_region(picture, hand.region, pen);
  for (const auto& hand : hands) draw_hand(picture, hand.points_px, pen);
  return picture;
}

}  // namespace handcast::detect
