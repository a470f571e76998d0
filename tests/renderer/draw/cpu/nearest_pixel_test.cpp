// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/nearest_pixel.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace handcast::renderer::cpu {
namespace {

using Mask = Image<std::uint8_t>;

/// Squared distance of the nearest seed, found by exhaustive search; -1 if it is out of reach.
int nearest_by_hand(const Mask& seeds, int x, int y, int reach_px) {
  int best = reach_px * reach_px + 1;
  for (int sy = 0; sy < seeds.height(); ++sy) {
    for (int sx = 0; sx < seeds.width(); ++sx) {
      if (seeds.at(sx, sy)) best = std::min(best, (sx - x) * (sx - x) + (sy - y) * (sy - y));
    }
  }
  return best > reach_px * reach_px ? -1 : best;
}

void expect_exact(const Mask& seeds, const Mask& wanted, int reach_px) {
  NearestPixel transform;
  std::map<std::pair<int, int>, NearestSeed> found;
  for (const NearestSeed& one : transform.find(seeds.view(), wanted.view(), reach_px)) {
    ASSERT_TRUE(found.emplace(std::pair{int{one.x}, int{one.y}}, one).second) << "twice";
    ASSERT_NE(wanted.at(one.x, one.y), 0);
    const int x = one.x + one.dx, y = one.y + one.dy;
    ASSERT_TRUE(x >= 0 && y >= 0 && x < seeds.width() && y < seeds.height());
    ASSERT_NE(seeds.at(x, y), 0) << "not a seed";
    ASSERT_EQ(one.squared_px, one.dx * one.dx + one.dy * one.dy);
  }
  for (int y = 0; y < wanted.height(); ++y) {
    for (int x = 0; x < wanted.width(); ++x) {
      if (!wanted.at(x, y)) continue;
      const auto one = found.find({x, y});
      ASSERT_EQ(one == found.end() ? -1 : one->second.squared_px,
                nearest_by_hand(seeds, x, y, reach_px))
          << x << ' ' << y;
    }
  }
}

Mask random_mask(std::mt19937& random, int width, int height, double density) {
  Mask mask(width, height);
  std::bernoulli_distribution set(density);
  for (std::uint8_t& pixel : mask.pixels()) pixel = set(random) ? 255 : 0;
  return mask;
}

void stamp_disc(Mask& mask, float x, float y, float radius, std::uint8_t value) {
  for (int py = 0; py < mask.height(); ++py) {
    for (int px = 0; px < mask.width(); ++px) {
      if ((px - x) * (px - x) + (py - y) * (py - y) <= radius * radius) mask.at(px, py) = value;
    }
  }
}

TEST(NearestPixel, IsExactOnRandomMasksOfEverySize) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> side(1, 80), reach(1, NearestPixel::kLargestReach);
  for (const double density : {0.0005, 0.01, 0.1, 0.7}) {
    for (int round = 0; round < 12; ++round) {
      const int width = side(random), height = side(random);
      expect_exact(random_mask(random, width, height, density),
                   random_mask(random, width, height, 0.5), reach(random));
    }
  }
}

TEST(NearestPixel, IsExactBetweenShapesLikeAHandThatMoved) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> x(0, 150), y(0, 100), radius(5, 40), shift(-20, 20);
  for (int round = 0; round < 6; ++round) {
    Mask drawn(150, 100), hand(150, 100);
    const float dx = shift(random), dy = shift(random);
    for (int disc = 0; disc < 4; ++disc) {
      const float cx = x(random), cy = y(random), r = radius(random);
      stamp_disc(drawn, cx, cy, r, 255);
      stamp_disc(hand, cx + dx, cy + dy, r, 255);
    }
    Mask seeds(150, 100), wanted(150, 100);
    for (std::size_t i = 0; i < seeds.pixels().size(); ++i) {
      seeds.pixels()[i] = drawn.pixels()[i] & hand.pixels()[i];
      wanted.pixels()[i] = hand.pixels()[i] & ~drawn.pixels()[i];
    }
    expect_exact(seeds, wanted, NearestPixel::kLargestReach);
  }
}

TEST(NearestPixel, SeesSeedsAtTheCornersFromTheCorners) {
  Mask seeds(33, 30), wanted(33, 30, 255);
  for (const auto& [x, y] : {std::pair{0, 0}, {32, 0}, {0, 29}, {32, 29}}) seeds.at(x, y) = 255;
  expect_exact(seeds, wanted, 32);
  expect_exact(seeds, wanted, 7);
}

TEST(NearestPixel, WithoutSeedsFindsNothing) {
  expect_exact(Mask(70, 40), Mask(70, 40, 255), 32);
  NearestPixel transform;
  EXPECT_TRUE(transform.find(Mask(70, 40).view(), Mask(70, 40, 255).view(), 32).empty());
}

TEST(NearestPixel, WhereAllAreSeedsEachIsItsOwn) {
  NearestPixel transform;
  const Mask all(70, 40, 255);
  const auto found = transform.find(all.view(), all.view(), 32);
  ASSERT_EQ(found.size(), 70u * 40u);
  for (const NearestSeed& one : found) ASSERT_EQ(one.squared_px, 0);
}

TEST(NearestPixel, ReachesExactlyAsFarAsItSays) {
  for (const int reach : {1, 5, 31, 32}) {
    Mask seeds(80, 80), wanted(80, 80, 255);
    seeds.at(40, 40) = 255;
    expect_exact(seeds, wanted, reach);
    NearestPixel transform;
    for (const NearestSeed& one : transform.find(seeds.view(), wanted.view(), reach))
      ASSERT_LE(one.squared_px, reach * reach);
  }
}

TEST(NearestPixel, WorksOnAPartOfALargerImage) {
  std::mt19937 random(9);
  const Mask seeds = random_mask(random, 100, 60, 0.01), wanted = random_mask(random, 100, 60, 0.3);
  Mask seeds_part(41, 23), wanted_part(41, 23);
  for (int y = 0; y < 23; ++y) {
    for (int x = 0; x < 41; ++x) {
      seeds_part.at(x, y) = seeds.at(x + 17, y + 11);
      wanted_part.at(x, y) = wanted.at(x + 17, y + 11);
    }
  }
  NearestPixel of_part, of_copy;
  const auto part = [](const Mask& mask) {
    return View<const std::uint8_t>{mask.row(11) + 17, 41, 23, 100};
  };
  const auto found = of_part.find(part(seeds), part(wanted), 20);
  const auto expected = of_copy.find(seeds_part.view(), wanted_part.view(), 20);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].dx, expected[i].dx);
    EXPECT_EQ(found[i].dy, expected[i].dy);
  }
}

TEST(NearestPixel, CallsDoNotRememberEarlierOnes) {
  NearestPixel transform;
  const Mask wanted(70, 40, 255), none(70, 40);
  EXPECT_EQ(transform.find(wanted.view(), wanted.view(), 32).size(), 70u * 40u);
  EXPECT_TRUE(transform.find(none.view(), wanted.view(), 32).empty());
  EXPECT_TRUE(transform.find(wanted.view(), none.view(), 32).empty());
}

}  // namespace
}  // namespace handcast::renderer::cpu
