// SPDX-License-Identifier: Apache-2.0
#include "renderer/ladder/rung.hpp"

#include <algorithm>
#include <span>

namespace handcast::renderer {
namespace {

constexpr std::array<int, kRungs> kFreeNumbers{
    0, 0, 2, 4, 4 + 2 * kFingers, 2 * kLandmarks, 2 * kLandmarks};

glm::vec2 mean_shift(const LandmarkPoints& p, const LandmarkPoints& q) {
  glm::vec2 sum{0};
  for (int i = 0; i < kLandmarks; ++i) sum += q[i] - p[i];
  return sum / static_cast<float>(kLandmarks);
}

/// The words of the setting must be "auto" and the names of the rungs, in their order.
constexpr bool words_are_rungs() {
  const auto words = words_of(config::RungChoice{});
  return std::ranges::equal(std::span(words).subspan(1), msg::kRungNames);
}
static_assert(words_are_rungs());

}  // namespace

Rung held_rung(config::RungChoice choice) {
  if (choice == config::RungChoice::automatic) return Rung::landmarks;
  return static_cast<Rung>(static_cast<int>(choice) - 1);
}

int degrees_of_freedom(Rung rung) { return kFreeNumbers[static_cast<std::size_t>(rung)]; }

glm::vec2 RungModel::moved(int landmark, const glm::vec2& at) const {
  const int finger = finger_of_landmark(landmark);
  return finger < 0 ? whole(at) : whole(at) + fingers[finger];
}

LandmarkPoints RungModel::moved(const LandmarkPoints& p) const {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) points[i] = moved(i, p[i]);
  return points;
}

RungModel fit_rung(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q) {
  RungModel model;
  if (rung == Rung::shift) model.whole.shift = mean_shift(p, q);
  if (rung > Rung::shift) model.whole = fit_similarity(p, q);
  if (rung < Rung::fingers) return model;
  constexpr float kShare = 0.25f;  // of each of four landmarks
  for (int i = 1; i < kLandmarks; ++i)
    model.fingers[finger_of_landmark(i)] += kShare * (q[i] - model.whole(p[i]));
  return model;
}

float residual_px2(const RungModel& model, const LandmarkPoints& p, const LandmarkPoints& q) {
  float sum = 0;
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::vec2 off = q[i] - model.moved(i, p[i]);
    sum += glm::dot(off, off);
  }
  return sum / static_cast<float>(kLandmarks);
}

}  // namespace handcast::renderer
