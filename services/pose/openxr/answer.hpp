// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::pose::openxr {

/// What a runtime says of one hand at the time that it was asked for.
struct Answer {
  bool is_active = false;                         ///< it tracks this hand
  bool is_whole = false;                          ///< it knows place and orientation of every joint
  int tracked = 0;                                ///< joints that it sees and does not infer
  std::array<msg::Joint, msg::kJoints> joints{};  ///< in the axes of the space
};

/// Both hands, indexed by msg::Side.
using Answers = std::array<Answer, 2>;

}  // namespace handcast::pose::openxr
