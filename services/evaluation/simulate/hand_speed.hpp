// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include "services/evaluation/twin/twin.hpp"

namespace handcast::simulate {

/// How fast the true hands are: the mean speed of a hand's 21 landmarks, over successive projector
/// frames, lit or not.
class HandSpeed {
 public:
  void add(msg::Side side, const std::array<glm::dvec3, msg::kLandmarks>& landmarks_m,
           std::int64_t lit_ns);
  /// {"mean","p95"} in m/s, the latter to a hundredth; null where no hand was seen.
  nlohmann::json to_json() const;

 private:
  static constexpr double kStep_m_s = 0.01;
  struct Trail {
    std::int64_t lit_ns = 0;
    std::array<glm::dvec3, msg::kLandmarks> landmarks_m{};
  };
  std::array<Trail, msg::kMaxHands> trails_;
  std::array<std::int64_t, 1000>
      counts_{};  ///< by speed, in steps; the last holds all that is faster
  std::int64_t count_ = 0;
  double sum_m_s_ = 0;
};

}  // namespace handcast::simulate
