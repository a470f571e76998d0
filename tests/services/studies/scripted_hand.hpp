// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::study {

inline constexpr double kStep_s = 1.0 / 60;  ///< between the samples of scripted hands

/// The joints of a hand of which some fingers (index to little) are bent, m: it lies in the plane
/// z = 0, fingers along y.
inline std::array<glm::vec3, msg::kJoints> hand_with(const std::array<bool, 4>& bent) {
  std::array<glm::vec3, msg::kJoints> joints{};
  for (std::size_t k = 0; k < 4; ++k)
    joints[2 + k] = {-0.03f - 0.01f * static_cast<float>(k), 0.02f * static_cast<float>(k), 0};
  for (std::size_t finger = 0; finger < 4; ++finger) {
    const float x = -0.02f + 0.02f * static_cast<float>(finger);
    const std::array<float, 5> straight{0.02f, 0.09f, 0.13f, 0.155f, 0.175f};
    for (std::size_t k = 0; k < 5; ++k) {
      const std::size_t joint = 6 + 5 * finger + k;
      joints[joint] = {x, straight[k], 0};
      // Bent: the last bones turn back to the palm.
      if (bent[finger] && k >= 3)
        joints[joint] = {x, 0.13f - 0.02f * static_cast<float>(k - 2), 0.025f};
    }
  }
  return joints;
}

}  // namespace handcast::study
