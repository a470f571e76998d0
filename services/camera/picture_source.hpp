// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"

namespace handcast::camera {

/// The images of a recording. One thread, which need not be the one that opened it.
class PictureSource {
 public:
  virtual ~PictureSource() = default;

  /// Reads the image of this index: exposure and losses to `frame`, the pixels, rows without
  /// padding, to `pixels`, which has the size of the calibration's image. Errors: bad_data (it is
  /// damaged).
  virtual Result<void> read(std::size_t index, msg::CameraFrame& frame,
                            std::span<std::uint8_t> pixels) = 0;
};

}  // namespace handcast::camera
