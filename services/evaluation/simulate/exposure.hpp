// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::simulate {

/// A frame of the twin's camera.
struct Exposure {
  std::uint64_t frame_id = 0;  ///< number of the frame
  std::int64_t origin_ns = 0;  ///< middle of its exposure, since the epoch
};

}  // namespace handcast::simulate
