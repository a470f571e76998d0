// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ipc/msg/header.hpp"

namespace handcast::msg {

/// The streams of the pictures of other people's programs, for the left and the right hand. No
/// service of a rig writes to them: the supervisor gives their rings with the right to write.
inline constexpr std::array<std::string_view, 2> kGuestPictures{"guest.left", "guest.right"};

/// A picture for a hand, in its UV space, from a program that is not part of the rig. The pixels
/// follow the struct in the same slot, row by row from the top, without padding: RGBA8, red first.
/// Published by: programs of other people (ipc/client/handcast.h).  Read by: services/content.
struct GuestPicture {
  static constexpr std::string_view layout = "GuestPicture/1";  ///< see type_hash()
  static constexpr std::uint32_t kLargest_px = 1024;            ///< width, and height

  Header header;  ///< origin_ns: the time that the picture was drawn for
  /// Size of the picture in pixels, 1 to kLargest_px.
  /// @{
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  /// @}
  /// How long it stays after published_ns if none follows; 0: until another one follows.
  std::int64_t lasts_ns = 0;
  std::uint32_t is_straight = 0;  ///< 1: the colours are not multiplied by alpha yet
  std::uint32_t reserved = 0;

  /// Size in bytes of a message with a picture of `width` x `height` pixels.
  static constexpr std::size_t bytes(std::size_t width, std::size_t height) {
    return bytes_with_tail(sizeof(GuestPicture), width, height, 4);
  }

  /// The first pixel. Valid only if the struct lies in a slot or buffer of at least used_bytes().
  /// @{
  std::uint32_t* pixels() { return reinterpret_cast<std::uint32_t*>(this + 1); }
  const std::uint32_t* pixels() const { return reinterpret_cast<const std::uint32_t*>(this + 1); }
  /// @}
  /// Size of this message in bytes, pixels included.
  std::size_t used_bytes() const { return bytes(width_px, height_px); }
};

}  // namespace handcast::msg
