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

inline constexpr int kMaxVertices = 4096;  ///< of one hand's mesh

/// Where one vertex of the drawn hand lands, after every correction: projector px from the centre
/// of the top-left pixel.
struct Landing {
  float x_px = 0;
  float y_px = 0;
};

struct ProjectedHand {
  Side side = Side::left;
  std::uint32_t vertex_count = 0;
  std::array<Landing, kMaxVertices> landings{};  ///< the first `vertex_count` are valid
};

/// What the projector was given: the lit region's pixels (RGBA8, alpha 0 = dark, >0 = light meant
/// for a hand) follow the struct row by row without padding; everything outside the region is dark.
/// Published by: services/projector ("projection.frames").  Read by: services/observer, previews.
struct Projection {
  static constexpr std::string_view layout = "Projection/2";

  Header header;  ///< frame_id: the projector's own; origin: made_from.image_ns
  MadeFrom made_from;
  std::int64_t target_ns = 0;  ///< the middle of the time the frame was drawn for
  std::int64_t lit_ns = 0;     ///< the middle of the time it was lit, as the projector reports it
  std::uint32_t width_px = 0;  ///< of the projector
  std::uint32_t height_px = 0;
  std::int32_t region_x_px = 0;  ///< top-left of the region
  std::int32_t region_y_px = 0;
  std::uint32_t region_width_px = 0;
  std::uint32_t region_height_px = 0;
  std::uint32_t hand_count = 0;
  std::uint32_t foldovers = 0;  ///< drawn triangles or grid cells that the correction turned over
  std::array<ProjectedHand, kMaxHands> hands{};

  static constexpr std::size_t bytes(std::size_t width, std::size_t height) {
    return bytes_with_tail(sizeof(Projection), width, height, 4);
  }

  std::uint32_t* pixels() { return reinterpret_cast<std::uint32_t*>(this + 1); }
  const std::uint32_t* pixels() const { return reinterpret_cast<const std::uint32_t*>(this + 1); }
  std::size_t used_bytes() const { return bytes(region_width_px, region_height_px); }
};

}  // namespace handcast::msg
