// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ipc/msg/header.hpp"

namespace handcast::msg {

/// The stream of the test pictures. No service of a rig writes to it: the supervisor gives its ring
/// with the right to write to programs that ask for it.
inline constexpr std::string_view kTestPictures = "calibration.pictures";

/// A grey picture that the projector shows in place of its hands, e.g. structured light. The levels
/// follow the struct in the same slot, row by row from the top, without padding: 0 dark to 255,
/// encoded as in sRGB. The projector shows it for kLasting_ns after it was published, so that hands
/// are lit again soon after its writer has died.
/// Published by: services/tools/calibrate ("calibration.pictures").  Read by: services/projector.
struct TestPicture {
  static constexpr std::string_view layout = "TestPicture/1";  ///< see type_hash()
  static constexpr std::int64_t kLasting_ns = 1'000'000'000;   ///< after published_ns

  Header header;  ///< frame_id: number of the picture, at least 1; the same if it is repeated
  /// Size of the picture in pixels: that of the projector's image.
  /// @{
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  /// @}

  /// Size in bytes of a message with a picture of `width` x `height` pixels.
  static constexpr std::size_t bytes(std::size_t width, std::size_t height) {
    return bytes_with_tail(sizeof(TestPicture), width, height, 1);
  }

  /// The first level. Valid only if the struct lies in a slot or buffer of at least used_bytes().
  /// @{
  std::uint8_t* levels() { return reinterpret_cast<std::uint8_t*>(this + 1); }
  const std::uint8_t* levels() const { return reinterpret_cast<const std::uint8_t*>(this + 1); }
  /// @}
  /// Size of this message in bytes, levels included.
  std::size_t used_bytes() const { return bytes(width_px, height_px); }
};

}  // namespace handcast::msg
