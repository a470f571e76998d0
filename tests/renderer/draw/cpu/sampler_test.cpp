// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/sampler.hpp"

#include <gtest/gtest.h>

#include <random>

namespace handcast::renderer::cpu {
namespace {

/// One place between four texels of a channel.
struct Four {
  std::array<std::uint32_t, 4> level;  ///< upper left and right, lower left and right
  std::uint32_t right, down;           ///< 0..255 of 256
  float factor;

  double exact() const {
    const std::uint32_t both = right * down / 256;
    const std::array weight{256 - right - down + both, right - both, down - both, both};
    double squares = 0;
    for (std::size_t k = 0; k < 4; ++k) squares += weight[k] * level[k] * level[k] / 256.0;
    return factor * std::sqrt(squares);
  }
};

/// What mix() makes of it, in all three channels.
std::array<std::uint32_t, 3> mixed(const Four& four) {
  Lookup at{};
  alignas(64) std::array<float, Lookup::kCount> factor{};
  alignas(64) std::array<std::uint32_t, Lookup::kCount> colour{};
  const auto texel = [&](std::size_t k) { return std::uint64_t{four.level[k] * 0x010101u}; };
  constexpr std::size_t kLane = 5;
  at.right[kLane] = four.right;
  at.down[kLane] = four.down;
  at.upper[kLane] = texel(0) | texel(1) << 32;
  at.lower[kLane] = texel(2) | texel(3) << 32;
  factor[kLane] = four.factor;
  mix(at, factor.data(), colour.data());
  return {colour[kLane] & 255, colour[kLane] >> 8 & 255, colour[kLane] >> 16};
}

TEST(Mix, IsWithinALevelOfTheRootOfTheMeanSquare) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::uint32_t> any(0, 255);
  for (int i = 0; i < 200'000; ++i) {
    const std::uint32_t most = i % 2 == 0 ? 255 : 12;  // dark ones too
    Four four{{}, any(random), any(random), static_cast<float>(any(random)) / 255};
    for (auto& level : four.level) level = any(random) * most / 255;
    for (const std::uint32_t level : mixed(four)) {
      ASSERT_LT(std::abs(level - four.exact()), 1.5)
          << testing::PrintToString(four.level) << ' ' << four.right << ' ' << four.down << ' '
          << four.factor;
    }
  }
}

TEST(Mix, ATexelAloneIsAsItIs) {
  for (std::uint32_t level = 0; level < 256; ++level)
    for (const std::uint32_t read : mixed({{level, 7, 99, 255}, 0, 0, 1})) ASSERT_EQ(read, level);
}

TEST(Mix, EqualTexelsAreAsTheyAreButInTheDark) {
  for (std::uint32_t level = 0; level < 256; ++level)
    for (const std::uint32_t part : {64u, 128u, 200u})
      for (const std::uint32_t read : mixed({{level, level, level, level}, part, part, 1}))
        ASSERT_NEAR(read, level, level < 8 && level > 0 ? 1 : 0) << level << ' ' << part;
}

/// Level 1 of 5 x 3 texels begins below level 0 and its border.
TEST(Sampler, AMapLeadsToTheTexelsOfItsLevel) {
  Texture picture(8, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) picture.at(x, y) = static_cast<std::uint32_t>(x + 16 * y);
  for (const bool smooth : {true, false}) {
    const MipChain chain(picture, smooth);
    const Sampler sampler(chain.view());
    ASSERT_EQ(sampler.maps().size(), static_cast<std::size_t>(chain.layout().levels()));
    for (int level = 0; level < chain.layout().levels(); ++level) {
      const int columns = 8 >> level, rows = 4 >> level;
      for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
          const glm::vec2 centre((static_cast<float>(column) + 0.5f) / static_cast<float>(columns),
                                 (static_cast<float>(row) + 0.5f) / static_cast<float>(rows));
          const glm::vec2 place = sampler.maps()[level].place(centre);
          Lookup at{};
          at.set(0, place.x, place.y, sampler.stride, sampler.fraction);
          at.read(0, sampler.texels, sampler.stride);
          EXPECT_EQ(static_cast<std::uint32_t>(at.upper[0]), chain.texel(level, column, row));
          EXPECT_EQ(at.right[0], 0u);
          EXPECT_NEAR(sampler.maps()[level].uv(place).x, centre.x, 1e-6f);
        }
    }
  }
}

TEST(Sampler, TheLowerRightCornerIsWithinTheChain) {
  for (const bool smooth : {true, false})
    for (const int height : {200, 256}) {  // rows are padded to 256
      const MipChain chain(Texture(4, height), smooth);
      const Sampler sampler(chain.view());
      const auto place = sampler.maps()[0].place({1, 1});
      Lookup at{};
      at.set(0, place.x, place.y, sampler.stride, sampler.fraction);
      const auto last = at.index[0] + sampler.stride + 1;
      EXPECT_LT(last, sampler.stride * chain.layout().rows()) << smooth << ' ' << height;
    }
}

TEST(Sampler, PlacesOutsideThePictureAreMovedToItsEdge) {
  const MipChain chain(Texture(4, 4, 0xffffffff), true);
  const TexelMap map = Sampler(chain.view()).maps()[0];
  EXPECT_EQ(map.within(map.place({-3, 5})), map.place({0, 1}));
  EXPECT_EQ(map.within({NAN, NAN}), map.place({0, 0}));
  EXPECT_EQ(map.within(map.place({0.25f, 0.5f})), map.place({0.25f, 0.5f}));
}

}  // namespace
}  // namespace handcast::renderer::cpu
