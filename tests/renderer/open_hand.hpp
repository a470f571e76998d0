// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <random>

#include "renderer/base/landmark_points.hpp"
#include "renderer/base/similarity.hpp"

namespace handcast::renderer {

/// The landmarks of a hand with five straight fingers, px.
inline LandmarkPoints open_hand() {
  LandmarkPoints points{glm::vec2(400, 500)};
  for (int i = 1; i < kLandmarks; ++i) {
    const int finger = (i - 1) / 4, joint = (i - 1) % 4;
    points[i] = {280.0f + 60.0f * finger, 380.0f - 45.0f * joint + 8.0f * std::abs(finger - 2)};
  }
  return points;
}

inline LandmarkPoints with_noise(LandmarkPoints points, unsigned seed, float noise_px = 5) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, noise_px);
  for (glm::vec2& point : points) point += glm::vec2(noise(random), noise(random));
  return points;
}

inline LandmarkPoints moved(LandmarkPoints points, const Similarity& move) {
  for (glm::vec2& point : points) point = move(point);
  return points;
}

}  // namespace handcast::renderer
