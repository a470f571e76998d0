// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/placed_texture.hpp"

namespace handcast::twin {

PlacedTexture::PlacedTexture(const Twin& twin)
    : twin_(twin),
      lookup_{TextureLookup(twin.hands().drawn(Side::left)),
              TextureLookup(twin.hands().drawn(Side::right))} {}

void PlacedTexture::place(const SeenHand& hand) {
  const auto& map = twin_.hands().texture(hand.side);
  auto& placed = placed_[static_cast<std::size_t>(hand.side)];
  const auto& mesh = hand.flesh->mesh;
  placed.seen_m.resize(map.size());
  placed.rest_m.resize(map.size());
  for (std::size_t v = 0; v < map.size(); ++v) {
    placed.seen_m[v] = map[v].on(mesh, hand.position_m);
    placed.rest_m[v] = map[v].on(mesh, mesh.positions);
  }
}

PlacedTexture::Point PlacedTexture::at(Side side, glm::vec2 uv) const {
  const auto s = static_cast<std::size_t>(side);
  const SurfacePoint point = lookup_[s].at(uv);
  const auto& mesh = twin_.hands().drawn(side);
  return {point.on(mesh, placed_[s].seen_m), point.on(mesh, placed_[s].rest_m)};
}

}  // namespace handcast::twin
