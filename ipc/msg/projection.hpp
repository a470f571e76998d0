// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/header.hpp"

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
  Side side = Side::left;          ///< the side whose mesh was drawn
  std::uint32_t vertex_count = 0;  ///< number of vertices
  float presence = 1;              ///< factor of all its levels (sRGB), 0..1
  std::uint32_t reserved = 0;
  std::array<Landing, kMaxVertices> landings{};  ///< the first `vertex_count` are valid
};

/// The place on a hand that the light shows at one pixel of the projector.
struct ShownPoint {
  /// Texture coordinates of the hand's mesh, 0..1 as 0..65535.
  /// @{
  std::uint16_t u = 0;
  std::uint16_t v = 0;
  /// @}
  std::uint8_t hand = 0;  ///< 0: the pixel is dark; otherwise 1 + index in Projection::hands
  std::uint8_t reserved = 0;
};

/// The image that was handed to the projector. The pixels of the lit region (RGBA8; alpha: its
/// light as a share of the light for a pixel that is all hand, 0: dark) follow the struct row by
/// row without padding; everything outside the region is dark. Then follow the shown points, one
/// per kShownStep_px pixels in both directions. Published by: services/projector
/// ("projection.frames"). Read by: services/observer, previews.
struct Projection {
  static constexpr std::string_view layout = "Projection/4";  ///< see type_hash()

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
  std::uint32_t has_shown = 0;  ///< 1: the shown points are valid; they are for an observer
  std::uint32_t reserved = 0;
  /// TestPicture::header.frame_id of the picture that was shown in place of hands; 0: none.
  std::uint64_t test_picture = 0;

  /// Distance of the shown points, px: they are the pixels of the region whose coordinates in the
  /// projector image are both multiples of it.
  static constexpr std::int32_t kShownStep_px = 4;

  /// Size in bytes of a message with a region of `width` x `height` pixels.
  static constexpr std::size_t bytes(std::size_t width, std::size_t height) {
    return bytes_with_tail(bytes_with_tail(sizeof(Projection), width, height, 4), shown_in(width),
                           shown_in(height), sizeof(ShownPoint));
  }

  /// The first pixel of the region. Valid only if the struct lies in a slot or buffer of at least
  /// used_bytes().
  /// @{
  std::uint32_t* pixels() { return reinterpret_cast<std::uint32_t*>(this + 1); }
  const std::uint32_t* pixels() const { return reinterpret_cast<const std::uint32_t*>(this + 1); }
  /// @}
  /// The shown point of a pixel of the region whose coordinates are multiples of kShownStep_px.
  /// Valid as pixels().
  /// @{
  ShownPoint& shown(std::int32_t x_px, std::int32_t y_px) {
    return reinterpret_cast<ShownPoint*>(pixels() + pixel_count())[shown_index(x_px, y_px)];
  }
  const ShownPoint& shown(std::int32_t x_px, std::int32_t y_px) const {
    return reinterpret_cast<const ShownPoint*>(pixels() + pixel_count())[shown_index(x_px, y_px)];
  }
  /// @}
  /// Size of this message in bytes, pixels and shown points included.
  std::size_t used_bytes() const { return bytes(region_width_px, region_height_px); }

 private:
  /// The most shown points in a row of pixels, wherever it begins.
  static constexpr std::size_t shown_in(std::size_t pixels) {
    return (pixels + kShownStep_px - 1) / kShownStep_px;
  }
  std::size_t pixel_count() const { return std::size_t{region_width_px} * region_height_px; }
  static constexpr std::int32_t first_shown(std::int32_t from_px) {
    return (from_px + kShownStep_px - 1) / kShownStep_px;
  }
  std::size_t shown_index(std::int32_t x_px, std::int32_t y_px) const {
    const std::int32_t column = x_px / kShownStep_px - first_shown(region_x_px),
                       row = y_px / kShownStep_px - first_shown(region_y_px);
    return static_cast<std::size_t>(row) * shown_in(region_width_px) +
           static_cast<std::size_t>(column);
  }
};

}  // namespace handcast::msg
