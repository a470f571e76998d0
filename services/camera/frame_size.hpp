// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"

namespace handcast::camera {

/// Checks that an image fits into the tail of its message. Errors: bad_config (it does not).
inline Result<void> check_room(int width_px, int height_px, std::size_t tail_bytes) {
  const std::size_t needed = static_cast<std::size_t>(width_px) * height_px;
  if (needed <= tail_bytes) return {};
  return fail(Errc::bad_config,
              fmt::format("an image of {} x {} px does not fit the {} bytes of its ring's slots",
                          width_px, height_px, tail_bytes));
}

}  // namespace handcast::camera
