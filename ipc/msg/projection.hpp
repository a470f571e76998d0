// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/header.hpp"
#include "ipc/msg/made_from.hpp"
#include "ipc/msg/tail.hpp"

namespace handcast::msg {

inline constexpr int kMaxVertices = 4096;  ///< vertices of the mesh of one hand

/// The position of one vertex of the drawn hand in the projector image, after all corrections: px
/// from the centre of the top-left pixel, x to the right, y down.
struct Landing {
  /// Coordinates in projector pixels.
  /// @{
  float x_px = 0;
  float y_px = 0;
  /// @}
};

/// The drawn vertices of one hand.
struct ProjectedHand {
  Side side = Side::left;                        ///< the side whose mesh was drawn
  std::uint32_t vertex_count = 0;                ///< number of vertices
  std::array<Landing, kMaxVertices> landings{};  ///< the first `vertex_count` are valid
};

/// The image that was handed to the projector. The pixels of the lit region (RGBA8; alpha:
/// the share of the pixel that is hand, 0: dark) follow the struct row by row without padding;
/// everything outside the region is dark. Published by: services/projector ("projection.frames").
/// Read by: services/observer, previews.
struct Projection {
  static constexpr std::string_view layout = "Projection/2";  ///< see type_hash()

  Header header;       ///< frame_id: counted by the projector; origin_ns: made_from.image_ns
  MadeFrom made_from;  ///< the inputs of the frame
  std::int64_t target_ns = 0;  ///< the middle of the time the frame was drawn for
  std::int64_t lit_ns = 0;     ///< the middle of the time it was lit, as the projector reports it
  /// Size of the projector image in pixels.
  /// @{
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  /// @}
  /// The lit region in projector pixels: top-left corner and size.
  /// @{
  std::int32_t region_x_px = 0;
  std::int32_t region_y_px = 0;
  std::uint32_t region_width_px = 0;
  std::uint32_t region_height_px = 0;
  /// @}
  std::uint32_t hand_count = 0;  ///< number of hands
  std::uint32_t foldovers = 0;   ///< drawn triangles or grid cells that the correction turned over
  std::array<ProjectedHand, kMaxHands> hands{};  ///< the first `hand_count` are valid

  /// Size in bytes of a message with a region of `width` x `height` pixels.
  static constexpr std::size_t bytes(std::size_t width, std::size_t height) {
    return bytes_with_tail(sizeof(Projection), width, height, 4);
  }

  /// The first pixel of the region. Valid only if the struct lies in a slot or buffer of at least
  /// used_bytes().
  /// @{
  std::uint32_t* pixels() { return reinterpret_cast<std::uint32_t*>(this + 1); }
  const std::uint32_t* pixels() const { return reinterpret_cast<const std::uint32_t*>(this + 1); }
  /// @}
  /// Size of this message in bytes, pixels included.
  std::size_t used_bytes() const { return bytes(region_width_px, region_height_px); }
};

}  // namespace handcast::msg
