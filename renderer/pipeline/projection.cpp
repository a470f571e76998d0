// SPDX-License-Identifier: Apache-2.0
#include "renderer/pipeline/projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

std::uint16_t to_u16(float share) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0f, 1.0f)));
}

/// The hand of a message by the index among the drawn hands: 1 + its own index.
std::array<std::uint8_t, 4> hands_by_drawing(const Frame& frame, std::uint32_t count) {
  std::array<std::uint8_t, 4> hands{};
  for (std::uint32_t i = 0; i < count; ++i)
    if (const int drawn = frame.hands[i].drawn_as; drawn >= 0)
      hands[static_cast<std::size_t>(drawn)] = static_cast<std::uint8_t>(i + 1);
  return hands;
}

void copy_shown(const Frame& frame, msg::Projection& projection) {
  constexpr int kStep = msg::Projection::kShownStep_px;
  const auto hands = hands_by_drawing(frame, projection.hand_count);
  const auto& region = frame.region;
  for (int y = (region.y0 + kStep - 1) / kStep * kStep; y < region.y1; y += kStep)
    for (int x = (region.x0 + kStep - 1) / kStep * kStep; x < region.x1; x += kStep) {
      auto& point = projection.shown(x, y);
      point = {};
      const SurfaceId surface = frame.surface.at(x, y);
      if (surface == 0) continue;
      const glm::vec2 uv = frame.uv.at(x, y);
      point = {to_u16(uv.x), to_u16(uv.y), hands[surface / 64], 0};
    }
  projection.has_shown = 1;
}

void copy_vertices(const FrameHand& hand, msg::ProjectedHand& projected) {
  projected.side = hand.side;
  projected.presence = hand.presence;
  projected.vertex_count = static_cast<std::uint32_t>(
      std::min<std::size_t>(hand.projected_px.size(), projected.landings.size()));
  for (std::uint32_t i = 0; i < projected.vertex_count; ++i)
    projected.landings[i] = {hand.projected_px[i].x, hand.projected_px[i].y};
}

}  // namespace

void write_projection(const Frame& frame, msg::Projection& projection, std::size_t tail_bytes) {
  projection.header.origin_ns = frame.made_from.image_ns;
  projection.made_from = frame.made_from;
  projection.target_ns = frame.target_ns;
  projection.width_px = static_cast<std::uint32_t>(frame.colour.width);
  projection.height_px = static_cast<std::uint32_t>(frame.colour.height);
  projection.test_picture = frame.test_picture;
  projection.foldovers = static_cast<std::uint32_t>(std::max(frame.foldovers, 0));
  projection.hand_count = static_cast<std::uint32_t>(
      std::min<std::size_t>(frame.hands.size(), projection.hands.size()));
  for (std::uint32_t i = 0; i < projection.hand_count; ++i)
    copy_vertices(frame.hands[i], projection.hands[i]);

  const auto& region = frame.region;
  projection.region_x_px = projection.region_y_px = 0;
  projection.region_width_px = projection.region_height_px = 0;
  projection.has_shown = 0;
  if (region.empty() || msg::Projection::bytes(static_cast<std::size_t>(region.width()),
                                               static_cast<std::size_t>(region.height())) >
                            sizeof projection + tail_bytes)
    return;
  copy_region(frame, projection);
  if (frame.surface.data != nullptr) copy_shown(frame, projection);
}

}  // namespace handcast::renderer
