// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include "services/content/source.hpp"

namespace handcast::content {

/// The left or the right hand of the build.
inline const renderer::HandMesh& made_hand(Side side) {
  static const std::array hands{*renderer::load_hand_or_default({}, Side::left),
                                *renderer::load_hand_or_default({}, Side::right)};
  return hands[static_cast<std::size_t>(side)];
}

/// An opening of a kind for one of them.
inline Opening opening_of(std::string kind, std::string what = {}, Side side = Side::left,
                          int width = 160, int height = 100) {
  Opening opening;
  opening.element = {std::move(kind), std::move(what), {}};
  opening.width = width;
  opening.height = height;
  opening.meshes = {&made_hand(Side::left), &made_hand(Side::right)};
  opening.side = side;
  return opening;
}

/// Opens a source that can be opened.
inline std::unique_ptr<Source> opened(const Opening& opening) {
  auto source = open_source(opening);
  EXPECT_TRUE(source) << source.error().what;
  return std::move(*source);
}

inline int alpha_of(std::uint32_t texel) { return static_cast<int>(texel >> 24); }
/// 0 red, 1 green, 2 blue.
inline int level_of(std::uint32_t texel, int channel) {
  return static_cast<int>(texel >> 8 * channel & 0xff);
}

/// The texel at the texture coordinates of a vertex.
inline std::uint32_t texel_at(const renderer::Texture& texture, const glm::vec2& uv) {
  return texture.at(static_cast<int>(uv.x * static_cast<float>(texture.width())),
                    static_cast<int>(uv.y * static_cast<float>(texture.height())));
}

}  // namespace handcast::content
