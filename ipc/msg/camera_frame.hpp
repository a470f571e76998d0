// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "ipc/msg/header.hpp"

namespace handcast::msg {

/// Images of a camera that were lost, by reason.
struct FrameLosses {
  std::uint32_t missing = 0;     ///< never arrived: gaps in the camera's numbers
  std::uint32_t incomplete = 0;  ///< arrived without some of their packets
  std::uint32_t underrun = 0;    ///< arrived when no buffer was free
  std::uint32_t skipped = 0;     ///< arrived, but a newer one was there when it could be published
};

/// The losses as a number, StageMark::detail of Stage::capture: 8 bits each, at most 255.
inline constexpr std::uint32_t detail_of(const FrameLosses& lost) {
  const auto byte = [](std::uint32_t count) { return std::min<std::uint32_t>(count, 255); };
  return byte(lost.missing) | byte(lost.incomplete) << 8 | byte(lost.underrun) << 16 |
         byte(lost.skipped) << 24;
}
/// The losses in a number.
inline constexpr FrameLosses losses_in(std::uint32_t detail) {
  return {detail & 0xff, detail >> 8 & 0xff, detail >> 16 & 0xff, detail >> 24};
}

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
