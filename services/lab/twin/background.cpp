// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/background.hpp"

#include <cmath>
#include <numbers>

namespace handcast::twin {
namespace {

constexpr float kCornerLoss = 0.3f;    ///< vignetting at the image's corners
constexpr float kTableAlbedo = 0.25f;  ///< of the background in daylight, relative to skin
constexpr int kThings = 14;

/// A bar (long) or a disc of clutter.
struct Thing {
  glm::vec2 middle_px, axis;  ///< unit axis
  float half_length_px, half_width_px;
  float grey;  ///< above the background

  /// Share of a pixel that it covers.
  float covers(glm::vec2 at) const {
    const glm::vec2 d = at - middle_px;
    const float along = std::abs(glm::dot(d, axis)), across = std::abs(d.x * axis.y - d.y * axis.x);
    const float beyond = glm::length(glm::vec2(std::max(0.0f, along - half_length_px), across));
    return std::clamp(half_width_px - beyond + 0.5f, 0.0f, 1.0f);
  }
};

Thing make_thing(std::uint64_t i, const config::TwinImage& settings, glm::vec2 size_px,
                 const Random& random) {
  const auto draw = [&](std::uint64_t what) { return static_cast<float>(random.uniform(i, what)); };
  const float angle = std::numbers::pi_v<float> * draw(2);
  const bool bar = i % 2 == 0;
  return {.middle_px = {draw(0) * size_px.x, draw(1) * size_px.y},
          .axis = {std::cos(angle), std::sin(angle)},
          .half_length_px = bar ? 30 + 90 * draw(3) : 0,
          .half_width_px = bar ? 2 + 8 * draw(4) : 6 + 24 * draw(4),
          .grey = static_cast<float>(settings.clutter * settings.gain) * (0.3f + 0.7f * draw(5))};
}

}  // namespace

float vignette_at(const calib::CameraModel& camera, float x_px, float y_px) {
  const glm::vec2 half(camera.width_px / 2.0f, camera.height_px / 2.0f);
  const glm::vec2 from_centre = glm::vec2(x_px, y_px) - half;
  return 1 -
         kCornerLoss * std::min(1.0f, glm::dot(from_centre, from_centre) / glm::dot(half, half));
}

glm::vec3 to_sun() { return glm::normalize(glm::vec3(-0.8f, -0.4f, -0.45f)); }

renderer::Image<float> make_background(const config::TwinImage& settings,
                                       const calib::CameraModel& camera, const Random& random) {
  renderer::Image<float> image(camera.width_px, camera.height_px);
  const glm::vec2 size(camera.width_px, camera.height_px);
  const auto sun = static_cast<float>(settings.sunlight * settings.gain) * kTableAlbedo;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const glm::vec2 at(x, y);
      const float sunny =
          1 - 0.5f * (at.x / size.x + at.y / size.y);  // brightest at the upper left
      image.at(x, y) =
          (static_cast<float>(settings.background) + sun * sunny) * vignette_at(camera, at.x, at.y);
    }
  if (settings.clutter == 0) return image;
  for (std::uint64_t i = 0; i < kThings; ++i) {
    const Thing thing = make_thing(i, settings, size, random);
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x)
        image.at(x, y) +=
            thing.covers({x, y}) * thing.grey * vignette_at(camera, float(x), float(y));
  }
  return image;
}

}  // namespace handcast::twin
