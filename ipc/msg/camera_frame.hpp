// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "ipc/msg/header.hpp"
#include "ipc/msg/tail.hpp"

namespace handcast::msg {

/// One 8-bit grey image; the pixels follow the struct in the same slot, row by row without padding.
/// Published by: services/camera ("camera.frames").  Read by: services/landmarks,
/// services/projector, observers.
struct CameraFrame {
  static constexpr std::string_view layout = "CameraFrame/1";

  Header header;  ///< origin: the middle of the exposure
  std::int64_t exposure_ns = 0;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;

  static constexpr std::size_t bytes(std::size_t width, std::size_t height) {
    return bytes_with_tail(sizeof(CameraFrame), width, height, 1);
  }

  std::uint8_t* pixels() { return reinterpret_cast<std::uint8_t*>(this + 1); }
  const std::uint8_t* pixels() const { return reinterpret_cast<const std::uint8_t*>(this + 1); }
  std::size_t used_bytes() const { return bytes(width_px, height_px); }
};

}  // namespace handcast::msg
