// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::msg {

/// The inputs of one projector frame: the newest of each kind when the frame was begun. All times
/// are CLOCK_MONOTONIC; 0 means that there was none.
struct MadeFrom {
  std::uint64_t image_id = 0;     ///< frame_id of the camera image
  std::int64_t image_ns = 0;      ///< the middle of its exposure
  std::int64_t pose_ns = 0;       ///< the sample time of the newest tracker sample
  std::int64_t landmarks_ns = 0;  ///< the exposure of the image that was searched for landmarks
};

}  // namespace handcast::msg
