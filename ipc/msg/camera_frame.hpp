// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "ipc/msg/frame_losses.hpp"
#include "ipc/msg/header.hpp"
#include "ipc/msg/tail.hpp"

namespace handcast::msg {

/// One 8-bit grey image. The pixels follow the struct in the same slot, row by row from the top,
/// without padding.
/// Published by: services/camera ("camera.frames").  Read by: services/landmarks,
/// services/projector, observers.
struct CameraFrame {
  static constexpr std::string_view layout = "CameraFrame/3";  ///< see type_hash()

  Header header;                 ///< origin_ns: the middle of the exposure
  std::int64_t exposure_ns = 0;  ///< duration of the exposure
  /// Uncertainty of header.origin_ns: half the width of the interval in which it lies. 0: unknown.
  std::int64_t origin_error_ns = 0;
  FrameLosses lost;  ///< between the frame before and this one
  /// Size of the image in pixels.
  /// @{
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  /// @}
  /// calib::Calibration::id of the camera service; 0: unknown, for any calibration.
  std::uint32_t calibration = 0;
  std::uint32_t reserved = 0;  ///< padding

  /// Size in bytes of a message with an image of `width` x `height` pixels.
  static constexpr std::size_t bytes(std::size_t width, std::size_t height) {
    return bytes_with_tail(sizeof(CameraFrame), width, height, 1);
  }

  /// The first pixel: height_px rows of width_px bytes. Valid only if the struct lies in a slot or
  /// buffer of at least used_bytes().
  /// @{
  std::uint8_t* pixels() { return reinterpret_cast<std::uint8_t*>(this + 1); }
  const std::uint8_t* pixels() const { return reinterpret_cast<const std::uint8_t*>(this + 1); }
  /// @}
  /// Size of this message in bytes, pixels included.
  std::size_t used_bytes() const { return bytes(width_px, height_px); }
};

}  // namespace handcast::msg
