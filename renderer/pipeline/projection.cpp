// SPDX-License-Identifier: Apache-2.0
#include "renderer/pipeline/projection.hpp"

#include <algorithm>
#include <cstring>

namespace handcast::renderer {
namespace {

void copy_region(const Frame& frame, msg::Projection& projection) {
  const auto& region = frame.region;
  projection.region_x_px = region.x0;
  projection.region_y_px = region.y0;
  projection.region_width_px = static_cast<std::uint32_t>(region.width());
  projection.region_height_px = static_cast<std::uint32_t>(region.height());
  std::uint32_t* to = projection.pixels();
  for (int y = region.y0; y < region.y1; ++y, to += region.width())
    std::memcpy(to, frame.colour.row(y) + region.x0,
                static_cast<std::size_t>(region.width()) * sizeof *to);
}

void copy_landings(const FrameHand& hand, msg::ProjectedHand& projected) {
  projected.side = hand.side;
  projected.vertex_count = static_cast<std::uint32_t>(
      std::min<std::size_t>(hand.landings.size(), projected.landings.size()));
  for (std::uint32_t i = 0; i < projected.vertex_count; ++i)
    projected.landings[i] = {hand.landings[i].x, hand.landings[i].y};
}

}  // namespace

void write_projection(const Frame& frame, msg::Projection& projection, std::size_t tail_bytes) {
  projection.header.origin_ns = frame.made_from.image_ns;
  projection.made_from = frame.made_from;
  projection.target_ns = frame.target_ns;
  projection.width_px = static_cast<std::uint32_t>(frame.colour.width);
  projection.height_px = static_cast<std::uint32_t>(frame.colour.height);
  projection.foldovers = static_cast<std::uint32_t>(std::max(frame.foldovers, 0));
  projection.hand_count = static_cast<std::uint32_t>(
      std::min<std::size_t>(frame.hands.size(), projection.hands.size()));
  for (std::uint32_t i = 0; i < projection.hand_count; ++i)
    copy_landings(frame.hands[i], projection.hands[i]);

  const auto& region = frame.region;
  projection.region_x_px = projection.region_y_px = 0;
  projection.region_width_px = projection.region_height_px = 0;
  const auto pixels = region.empty() ? 0
                                     : static_cast<std::size_t>(region.width()) *
                                           static_cast<std::size_t>(region.height());
  if (pixels > 0 && pixels * sizeof(std::uint32_t) <= tail_bytes) copy_region(frame, projection);
}

}  // namespace handcast::renderer
