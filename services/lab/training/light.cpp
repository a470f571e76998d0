// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "renderer/base/clones.hpp"
#include "services/lab/training/scene.hpp"

namespace handcast::landmarks::training {
namespace {

/// Adds the fraction of the hemisphere over each point that a ball occludes: r^2 cos / d^2. The
/// root of d^2 is approximated by a line, for 13 to 60 mm.
HANDCAST_CLONES
void add_occlusion(const glm::vec3* positions, const glm::vec3* normals, std::size_t count,
                   glm::vec3 ball, float* occlusion) {
  constexpr float kRadius2 = 0.009f * 0.009f, kNear2 = 0.013f * 0.013f, kFar2 = 0.06f * 0.06f,
                  kTypical = 0.03f;
  for (std::size_t v = 0; v < count; ++v) {
    const float x = ball.x - positions[v].x, y = ball.y - positions[v].y,
                z = ball.z - positions[v].z;
    const float facing = x * normals[v].x + y * normals[v].y + z * normals[v].z;
    const float distance2 = x * x + y * y + z * z;
    const float distance = (distance2 + kTypical * kTypical) * (0.5f / kTypical);
    const float taken = kRadius2 * facing / (distance * (distance2 + 1e-9f));
    occlusion[v] += facing > 0 && distance2 > kNear2 && distance2 < kFar2 ? taken : 0.0f;
  }
}

}  // namespace

Light::Light(Dice& dice, const glm::vec3& hand_m) : plane_m_(hand_m.z) {
  const float beside_m = dice.chance(0.3f) ? 0.09f : 0.035f;
  lamp_m_ = {dice.normal(beside_m), dice.normal(beside_m), dice.normal(0.03f)};
  distance_m_ = glm::distance(lamp_m_, hand_m);
  falloff_ = dice.between(1.5f, 4);
  wrap_ = dice.between(0, 0.45f);
  contrast_ = dice.between(0.6f, 1.3f);
  gloss_ = dice.between(0, 0.2f);
  beam_m_ = dice.chance(0.6f) ? dice.between(0.11f, 0.4f) : 0;
  spot_m_ = glm::vec2(hand_m) + glm::vec2(dice.normal(0.06f), dice.normal(0.06f));
}

void Light::shade(const Surface& surface, std::vector<float>& grey) const {
  grey.resize(surface.positions.size());
  for (std::size_t v = 0; v < grey.size(); ++v) {
    const glm::vec3 place = surface.positions[v], normal = surface.normals[v];
    const glm::vec3 way = lamp_m_ - place;
    const float distance2 = glm::dot(way, way);
    const glm::vec3 to_lamp = way / std::sqrt(distance2);
    const float facing = std::max(0.0f, (glm::dot(normal, to_lamp) + wrap_) / (1 + wrap_));
    const glm::vec3 half = glm::normalize(to_lamp - glm::normalize(place));
    const float shine = std::max(0.0f, glm::dot(normal, half));
    const float shine4 = shine * shine * shine * shine;
    float lit = std::exp2(0.5f * falloff_ * std::log2(distance_m_ * distance_m_ / distance2));
    if (beam_m_ > 0) {
      const glm::vec2 off = glm::vec2(place) * (plane_m_ / place.z) - spot_m_;
      lit *= std::exp(-0.5f * glm::dot(off, off) / (beam_m_ * beam_m_));
    }
    grey[v] = lit * (surface.albedo[v] * std::exp2(contrast_ * std::log2(facing + 1e-6f)) +
                     gloss_ * shine4 * shine4 * shine4 * shine4);
  }
}

void occlude(const Surface& surface, std::span<const glm::vec3> balls, float strength,
             std::vector<float>& grey) {
  std::vector<float> occlusion(grey.size());
  for (const glm::vec3& ball : balls)
    add_occlusion(surface.positions.data(), surface.normals.data(), grey.size(), ball,
                  occlusion.data());
  for (std::size_t v = 0; v < grey.size(); ++v)
    grey[v] *= std::max(0.15f, 1 - strength * occlusion[v]);
}

}  // namespace handcast::landmarks::training
