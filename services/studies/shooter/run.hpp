// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::study {

/// Steers by the tilt of the palm about the forearm, from how it is held at first.
class TiltSteering {
 public:
  explicit TiltSteering(msg::Side side) : side_(side) {}
  /// -1 (left, as who looks at the palm sees it) to 1, for the joints of the hand, m. A hand that
  /// was away for longer than a second is held anew.
  float at(double time_s, const std::array<glm::vec3, msg::kJoints>& joints);

 private:
  msg::Side side_;
  std::optional<glm::mat3> rest_;  ///< axes of the palm at first
  double seen_s_ = 0;
};

/// `handcast study shooter`. Returns the exit code.
int run_shooter(int argc, char** argv);

}  // namespace handcast::study
