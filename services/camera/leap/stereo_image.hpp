// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "ipc/msg/frame_losses.hpp"
#include "services/camera/keep/mailbox.hpp"

namespace handcast::camera::leap {

/// The images of both eyes: byte 2i is pixel i of the left one, byte 2i + 1 of the right one.
struct StereoImage {
  std::vector<std::uint8_t> bytes;    ///< two for each pixel
  std::uint64_t number = 0;           ///< see Mailbox
  std::int64_t exposed_ns = 0;        ///< the middle of the exposure, CLOCK_MONOTONIC
  std::int64_t exposed_error_ns = 0;  ///< uncertainty of exposed_ns
  msg::FrameLosses lost;              ///< see Mailbox
};

using Mailbox = camera::Mailbox<StereoImage>;

}  // namespace handcast::camera::leap
