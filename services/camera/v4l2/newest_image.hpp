// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "services/camera/v4l2/loss_count.hpp"
#include "services/camera/v4l2/stream.hpp"

namespace handcast::camera::v4l2 {

/// An image and its number.
struct Numbered {
  Filled image;
  std::uint64_t number = 0;
};

/// Takes everything from a stream and gives all but the newest image back. Broken images are
/// dropped. If all buffers were full, even the newest image may be old, because the driver had no
/// buffer for those after it: all are dropped. Empty if no image is left. Errors: disconnected.
Result<std::optional<Numbered>> take_newest(Stream& stream, LossCount& losses);

}  // namespace handcast::camera::v4l2
