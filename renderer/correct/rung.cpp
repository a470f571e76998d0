// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/rung.hpp"

#include <array>

#include "renderer/base/similarity.hpp"

namespace handcast::renderer {
namespace {

glm::vec2 mean_shift(const LandmarkPoints& p, const LandmarkPoints& q) {
  glm::vec2 sum{0};
  for (int i = 0; i < kLandmarks; ++i) sum += q[i] - p[i];
  return sum / static_cast<float>(kLandmarks);
}

static_assert(words_of(config::RungChoice{}) == msg::kRungNames);

}  // namespace

Rung rung_of(config::RungChoice choice) { return static_cast<Rung>(choice); }

LandmarkPoints on_rung(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q) {
  if (rung <= Rung::predict) return p;
  if (rung >= Rung::landmarks) return q;
  Similarity whole;
  if (rung == Rung::shift)
    whole.shift = mean_shift(p, q);
  else
    whole = fit_similarity(p, q);
  std::array<glm::vec2, kFingers> finger{};
  constexpr float kShare = 0.25f;  // of each of four landmarks
  if (rung == Rung::fingers)
    for (int i = 1; i < kLandmarks; ++i)
      finger[finger_of_landmark(i)] += kShare * (q[i] - whole(p[i]));
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) {
    points[i] = whole(p[i]);
    if (i > 0) points[i] += finger[finger_of_landmark(i)];
  }
  return points;
}

}  // namespace handcast::renderer
