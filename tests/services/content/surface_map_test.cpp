// SPDX-License-Identifier: Apache-2.0
#include "services/content/surface_map.hpp"

#include <set>

#include "tests/services/content/made_hand.hpp"

namespace handcast::content {
namespace {

TEST(SurfaceMapTest, ATexelLiesWhereItsTextureCoordinatesAre) {
  const auto& hand = made_hand(Side::left);
  const SurfaceMap map(hand, 320, 200);
  EXPECT_GT(map.texels().size(), 320u * 200u / 5);
  std::set<std::uint32_t> seen;
  for (const auto& texel : map.texels()) {
    EXPECT_TRUE(seen.insert(texel.index).second);
    EXPECT_NEAR(texel.parts[0] + texel.parts[1] + texel.parts[2], 1, 1e-5);
    const auto uv = texel.of(std::span<const glm::vec2>(hand.uv));
    EXPECT_NEAR(uv.x * 320 - 0.5f, static_cast<float>(texel.index % 320), 1e-2);
    EXPECT_NEAR(uv.y * 200 - 0.5f, static_cast<float>(texel.index / 320), 1e-2);
  }
}

TEST(SurfaceMapTest, AChartIsContinuedOutwardsAndTheRestIsCleared) {
  const SurfaceMap map(made_hand(Side::right), 160, 100);
  renderer::Texture texture(160, 100, 0x12345678);
  for (const auto& texel : map.texels()) texture.pixels()[texel.index] = 0xffffffff;
  map.pad(texture);
  std::size_t white = 0, clear = 0;
  for (const auto texel : texture.pixels()) {
    white += texel == 0xffffffff;
    clear += texel == 0;
  }
  EXPECT_EQ(white + clear, texture.pixels().size());
  EXPECT_GT(white, map.texels().size() + 500);
  EXPECT_GT(clear, 0u);
  for (const auto& texel : map.texels()) {
    const int x = static_cast<int>(texel.index) % 160, y = static_cast<int>(texel.index) / 160;
    if (x < 159 && y > 0) {
      EXPECT_NE(texture.at(x + 1, y - 1), 0u);
    }
  }
}

TEST(SurfaceMapTest, PlacesAtRestAreInTheAxesOfTheWrist) {
  for (const Side side : {Side::left, Side::right}) {
    const auto& hand = made_hand(side);
    const auto places = rest_positions_mm(hand);
    const auto normals = rest_normals(hand);
    float farthest = 0, backs = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
      farthest = std::min(farthest, places[v].z);
      if (places[v].y > 10) backs += normals[v].y;
    }
    EXPECT_LT(farthest, -150) << "the tips lie away from the arm";
    EXPECT_GT(farthest, -250);
    EXPECT_GT(backs, 0) << "what is above points up";
  }
}

TEST(SurfaceMapTest, ATexelIsPremultiplied) {
  EXPECT_EQ(texel_of({1, 0.5f, 0, 0.5f}), 0x80004080u);
  EXPECT_EQ(texel_of({2, -1, 0, 3}), 0xff0000ffu);
}

}  // namespace
}  // namespace handcast::content
