// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/pose/leapc/declarations.hpp"

namespace handcast::pose::leapc {

/// A tracking event with the hands of a rig. Nothing in it points into the library.
struct Tracked {
  std::int64_t frame_id = 0;
  std::int64_t stamp_us = 0;  ///< by the service's clock
  msg::HandPoses poses;       ///< without header; at most one hand of each side
};

/// Reads a message of kind kTracking. Of several hands of one side, the one that has been visible
/// for longest is taken. Errors (bad_data): memory that cannot be read, numbers that are not
/// finite, more hands than any device sees.
Result<Tracked> read_tracking(const Message& message);

/// The joints of one hand of the library. Errors: bad_data (a number is not finite, or no side).
Result<msg::HandPose> pose_of(const Hand& hand);

}  // namespace handcast::pose::leapc
