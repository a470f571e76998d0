// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/skin_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handcast::twin {
namespace {

constexpr float kFine_m = 0.004f, kCoarse_m = 0.015f;  ///< sizes of the noise
constexpr float kCrease_m = 0.002f;                    ///< half the width of a crease
constexpr float kStripe_m = 0.024f;                    ///< period of the projected stripes
constexpr float kFingerRadius_mm = 8;
constexpr float kThinGain = 0.5f;  ///< of the light in a part without thickness

/// Noise in -1..1: random values at the corners of a grid, smoothly interpolated (Perlin 1985).
float value_noise(const glm::vec3& at, const Random& random) {
  const glm::vec3 cell = glm::floor(at), f = at - cell, u = f * f * (3.0f - 2.0f * f);
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 d(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::ivec3 c = glm::ivec3(cell) + d + 4096;
    const auto index = static_cast<std::uint64_t>((c.x * 8192LL + c.y) * 8192LL + c.z);
    const glm::vec3 w = glm::mix(1.0f - u, u, glm::vec3(d));
    sum += w.x * w.y * w.z * static_cast<float>(random.spread(index));
  }
  return sum;
}

float noise_at(const glm::vec3& p, const Random& random) {
  return 0.5f * value_noise(p / kFine_m, random) + 0.5f * value_noise(p / kCoarse_m, random);
}

glm::vec3 place(const renderer::HandMesh& hand, int joint) {
  return glm::vec3(hand.rest[joint][3]);
}

/// True for the joints at which fingers bend: all but wrist, palm, metacarpals and tips.
bool bends(int joint) {
  constexpr int kThumbTip = 5;
  if (joint < kThumbTip) return joint >= 3;
  const int of_finger = (joint - kThumbTip - 1) % 5;  // 0 metacarpal ... 4 tip
  return joint > kThumbTip && of_finger >= 1 && of_finger <= 3;
}

/// Distance along the bone from the nearest bend of a finger, m.
float from_bend_m(const renderer::HandMesh& hand, const glm::vec3& p) {
  float nearest_m = 1, along_m = 1;
  for (int j = 3; j + 1 < msg::kJoints; ++j) {
    const int parent = renderer::kJointParent[static_cast<std::size_t>(j)];
    if (!bends(j) || parent < 1) continue;
    const glm::vec3 bone = glm::normalize(place(hand, j) - place(hand, parent));
    const float distance_m = glm::distance(p, place(hand, j));
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    along_m = std::abs(glm::dot(p - place(hand, j), bone));
  }
  return nearest_m < 0.02f ? along_m : 1;
}

/// Distance from the nearest bone, m: half the thickness of the flesh.
float from_bone_m(const renderer::HandMesh& hand, const glm::vec3& p) {
  float nearest_m = 1;
  for (int j = 2; j < msg::kJoints; ++j) {
    const int parent = renderer::kJointParent[static_cast<std::size_t>(j)];
    if (parent < 0) continue;
    const glm::vec3 a = place(hand, parent), ab = place(hand, j) - a;
    const float t = std::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-9f), 0.0f, 1.0f);
    nearest_m = std::min(nearest_m, glm::distance(p, a + t * ab));
  }
  return nearest_m;
}

}  // namespace

float wrap_of(double subsurface_mm) {
  return static_cast<float>(subsurface_mm / (subsurface_mm + double(kFingerRadius_mm)));
}

std::vector<float> noise_pattern(std::span<const glm::vec3> points_m, double contrast,
                                 const Random& random) {
  std::vector<float> factor;
  for (const glm::vec3& p : points_m)
    factor.push_back(1 + static_cast<float>(contrast) * noise_at(p, random));
  return factor;
}

std::vector<float> skin_pattern(const renderer::HandMesh& hand, const config::TwinImage& settings,
                                const Random& random) {
  if (settings.texture == 0 && settings.subsurface_mm == 0 && settings.leak == 0) return {};
  const auto texture = static_cast<float>(settings.texture),
             leak = static_cast<float>(settings.leak),
             path_m = static_cast<float>(settings.subsurface_mm * 1e-3);
  std::vector<float> factor;
  for (const glm::vec3& p : hand.positions) {
    float light = 1;
    if (path_m > 0) light += kThinGain * std::exp(-2 * from_bone_m(hand, p) / path_m);
    const float stripe = 2 * std::numbers::pi_v<float> * (p.x + p.z) / kStripe_m;
    light += leak * (0.5f + 0.5f * std::sin(stripe));
    if (texture > 0) {
      const float crease = from_bend_m(hand, p) / kCrease_m;
      light *= 1 + texture * (noise_at(p, random) - 0.5f * std::exp(-crease * crease));
    }
    factor.push_back(std::max(0.0f, light));
  }
  return factor;
}

}  // namespace handcast::twin
