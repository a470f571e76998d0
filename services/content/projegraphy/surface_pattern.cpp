// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/surface_pattern.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::projegraphy {
namespace {

/// A random number 0..1 of a cell.
float dice(const glm::ivec2& cell) {
  auto bits = static_cast<std::uint32_t>(cell.x) * 0x9e3779b1u ^
              static_cast<std::uint32_t>(cell.y) * 0x85ebca77u;
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
  bits = (bits ^ bits >> 12) * 0x297a2d39u;
  return static_cast<float>((bits ^ bits >> 15) >> 8) / 16777216.f;
}

float smooth(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

/// Smooth noise 0..1 with cells of size 1.
float noise(const glm::vec2& at) {
  const glm::vec2 cell = glm::floor(at), in = at - cell, part = in * in * (3.f - 2.f * in);
  const glm::ivec2 c(cell);
  return std::lerp(std::lerp(dice(c), dice(c + glm::ivec2(1, 0)), part.x),
                   std::lerp(dice(c + glm::ivec2(0, 1)), dice(c + 1), part.x), part.y);
}

/// To the border between the nearest two of scattered points, and which one is the nearest.
struct Plate {
  float border = 0, which = 0;
};
Plate plate_at(const glm::vec2& at) {
  const glm::ivec2 middle(glm::floor(at));
  float first = 9, second = 9, which = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const glm::ivec2 cell = middle + glm::ivec2(dx, dy);
      const glm::vec2 point =
          glm::vec2(cell) + 0.15f + 0.7f * glm::vec2(dice(cell), dice(cell + glm::ivec2(57, 113)));
      const float distance = glm::distance(point, at);
      if (distance < first) {
        second = first;
        first = distance;
        which = dice(cell * 7);
      } else {
        second = std::min(second, distance);
      }
    }
  return {second - first, which};
}

/// Rows of rounded scales that overlap against the way; `at` in units of a scale.
float scale_rows(const glm::vec2& at) {
  const float row = std::floor(at.x), odd = 0.5f * static_cast<float>(static_cast<int>(row) & 1);
  const float across = at.y + odd, x = at.x - row, y = across - std::floor(across) - 0.5f;
  const float rim = std::hypot(x, 1.4f * y);
  return 0.25f + 0.75f * smooth(1.02f, 0.55f, rim) - 0.3f * smooth(0.4f, 0.f, x) +
         0.15f * dice({static_cast<int>(row), static_cast<int>(std::floor(across))});
}

}  // namespace

float lightness_of(Pattern pattern, const glm::vec2& at, const glm::vec2& along) {
  const glm::vec2 lain(glm::dot(at, along), along.x * at.y - along.y * at.x);
  switch (pattern) {
    case Pattern::fur: {
      const float wave = 0.25f * noise(9.f * at);
      return 0.15f + 0.5f * noise({8 * lain.x + 3 * wave, 60 * lain.y + 6 * wave}) +
             0.35f * noise(4.f * at);
    }
    case Pattern::feathers: {
      const glm::vec2 feather = lain * glm::vec2(7, 9);
      return 0.85f * scale_rows(feather) + 0.15f * noise({6 * lain.x, 90 * lain.y});
    }
    case Pattern::scales:
      return scale_rows(lain * glm::vec2(13, 14));
    case Pattern::plates: {
      const auto plate = plate_at(4.5f * at);
      return smooth(0.03f, 0.14f, plate.border) * (0.7f + 0.3f * plate.which);
    }
    case Pattern::patches: {
      const auto plate = plate_at(4.2f * at);
      return 1 - smooth(0.1f, 0.17f, plate.border) * (0.75f + 0.25f * plate.which);
    }
    case Pattern::stripes: {
      const float bent = 13 * lain.x + 2.2f * noise(3.f * at) + 4 * std::abs(lain.y);
      return smooth(-0.25f, 0.35f, std::sin(3.1f * bent)) * 0.8f +
             0.2f * noise({8 * lain.x, 60 * lain.y});
    }
    case Pattern::wrinkles: {
      const float lines = std::sin(42 * lain.x + 5 * noise(5.f * at));
      return 0.75f - 0.35f * smooth(0.75f, 1.f, lines) + 0.25f * noise(7.f * at);
    }
    case Pattern::bumps: {
      const auto plate = plate_at(11.f * at);
      return 0.35f + 0.4f * smooth(0.f, 0.5f, plate.border) + 0.35f * noise(5.f * at);
    }
    case Pattern::plain:
      break;
  }
  return 0.9f;
}

}  // namespace handcast::projegraphy
