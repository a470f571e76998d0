// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include "services/lab/twin/twin.hpp"

namespace handcast::simulate {

/// Speed of the true hands: the mean over the 21 landmarks of a hand between successive projector
/// frames, whether or not the hand is lit.
class HandSpeed {
 public:
  /// Adds the landmarks of one hand (one space, metres) at the time of a projector frame. Returns
  /// the speed, m/s; 0 for the first frame of a hand.
  double add(msg::Side side, const std::array<glm::dvec3, msg::kLandmarks>& landmarks_m,
             std::int64_t display_ns);
  /// {"mean", "p95"} in m/s, the latter to 0.01; null if there was no hand.
  nlohmann::json to_json() const;

 private:
  static constexpr double kStep_m_s = 0.01;
  struct Trail {
    std::int64_t display_ns = 0;
    std::array<glm::dvec3, msg::kLandmarks> landmarks_m{};
  };
  std::array<Trail, msg::kMaxHands> trails_;
  /// Number of speeds by steps of kStep_m_s; the last counts all higher ones.
  std::array<std::int64_t, 1000> counts_{};
  std::int64_t count_ = 0;
  double sum_m_s_ = 0;
};

}  // namespace handcast::simulate
