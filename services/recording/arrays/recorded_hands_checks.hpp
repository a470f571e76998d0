// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "ipc/msg/hand_poses.hpp"

/// Recognises recordings in other units and those that no hand can have made.
namespace handcast::recording {

/// Why these cannot be the times of a sensor in microseconds. Empty if they can.
std::string fault_of_times(std::span<const double> times_us);

/// Why these cannot be the poses of one hand, in metres, at these times. Empty if they can. Samples
/// whose wrist and knuckle are at one place are not examined.
std::string fault_of_poses(std::span<const msg::HandPose> poses,
                           std::span<const std::int64_t> time_ns);

}  // namespace handcast::recording
