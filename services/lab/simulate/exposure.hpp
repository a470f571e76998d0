// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::simulate {

/// A frame of the twin's camera.
struct Exposure {
  std::uint64_t frame_id = 0;  ///< number of the frame
  std::int64_t origin_ns = 0;  ///< true middle of its exposure, since the epoch
  std::int64_t stamp_ns = 0;   ///< that time by the camera's clock, which the cascade sees
};

}  // namespace handcast::simulate
