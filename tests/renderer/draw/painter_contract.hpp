// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include "renderer/base/srgb.hpp"
#include "tests/renderer/draw/painter_scene.hpp"

/// The contract of every back end of Painter: what draw() does. The test of a back end includes
/// this file, fill_contract.hpp and warp_contract.hpp, and instantiates the suite:
///
///     INSTANTIATE_TEST_SUITE_P(cpu, PainterContract, testing::Values(&open_cpu));
namespace handcast::renderer::test {

/// Opens the painter. If it cannot be opened here, its tests are skipped and print the error.
using OpenPainter = Result<std::unique_ptr<Painter>> (*)(int width_px, int height_px);

class PainterContract : public testing::TestWithParam<OpenPainter> {
 protected:
  static constexpr int kWidth = 200, kHeight = 150;
  static constexpr Rect kWhole{0, 0, kWidth, kHeight};

  void SetUp() override {
    auto opened = GetParam()(kWidth, kHeight);
    if (!opened) GTEST_SKIP() << opened.error().what;
    painter_ = std::move(*opened);
  }

  std::uint32_t colour(int x, int y) { return painter_->colour().at(x, y); }
  std::uint32_t alpha(int x, int y) { return colour(x, y) >> 24; }
  SurfaceId surface(int x, int y) { return painter_->surface().at(x, y); }
  glm::vec2 uv(int x, int y) { return painter_->uv().at(x, y); }

  int lit_pixels(Rect region = kWhole) {
    int lit = 0;
    for (int y = region.y0; y < region.y1; ++y) {
      for (int x = region.x0; x < region.x1; ++x) lit += surface(x, y) != 0;
    }
    return lit;
  }
  /// Colour and surface id must agree on which pixels are lit.
  void expect_consistent(Rect region = kWhole) {
    for (int y = region.y0; y < region.y1; ++y) {
      for (int x = region.x0; x < region.x1; ++x)
        ASSERT_EQ(surface(x, y) != 0, alpha(x, y) != 0) << x << ' ' << y;
    }
  }
  FillCounts fill(const Image<std::uint8_t>& mask, Rect region = kWhole) {
    return painter_->fill(mask.view(), settings_, region);
  }

  std::unique_ptr<Painter> painter_;
  config::Fill settings_{
      .method = config::FillMethod::reflect, .reach_px = 32, .fade_px = 0, .seam_uv = 0.04};
};

TEST_P(PainterContract, DrawsWhatASlowRasteriserInDoublePrecisionDraws) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> x(-40, kWidth + 40), y(-40, kHeight + 40), unit(0, 1),
      depth(0.5f, 1.5f);
  // Back ends may snap corners to sixteenths of a pixel, and those of triangles that they cut at
  // the screen's border to 1/256 px.
  constexpr double kSlackPx = 1 / 256.0;
  const auto sixteenths = [](float px) { return std::round(px * 16) / 16; };
  for (int scene = 0; scene < 20; ++scene) {
    Shape shape;
    for (int t = 0; t < 12; ++t) {
      const auto chart = static_cast<std::uint8_t>(1 + t % 5);
      const auto corner = [&] {
        return shape.vertex({sixteenths(x(random)), sixteenths(y(random))},
                            {unit(random), unit(random)}, depth(random), chart);
      };
      const int a = corner(), b = corner(), c = corner();
      const glm::vec2 ab = shape.position_px()[b] - shape.position_px()[a],
                      ac = shape.position_px()[c] - shape.position_px()[a];
      ab.x* ac.y > ab.y* ac.x ? shape.triangle(a, b, c)
                              : shape.triangle(a, c, b);  // all with one winding, as a sheet
    }
    draw(*painter_, shape, kWhole);
    for (int py = 0; py < kHeight; ++py) {
      for (int px = 0; px < kWidth; ++px) {
        std::vector<Seen> seen = seen_at(shape, px, py, kSlackPx);
        const bool sure = std::all_of(seen.begin(), seen.end(),
                                      [&](const Seen& s) { return s.margin_px > kSlackPx; });
        if (!sure) continue;  // on an edge: both results are right
        std::sort(seen.begin(), seen.end(),
                  [](const Seen& a, const Seen& b) { return a.depth_m < b.depth_m; });
        ASSERT_EQ(surface(px, py) != 0, !seen.empty()) << px << ' ' << py;
        if (seen.empty() || (seen.size() > 1 && seen[1].depth_m - seen[0].depth_m < 1e-4)) continue;
        ASSERT_EQ(surface(px, py), seen[0].surface) << px << ' ' << py;
        ASSERT_NEAR(uv(px, py).x, seen[0].uv.x, 1e-3) << px << ' ' << py;
        ASSERT_NEAR(uv(px, py).y, seen[0].uv.y, 1e-3) << px << ' ' << py;
        ASSERT_EQ(colour(px, py), texel_at(shape.texture(), uv(px, py))) << px << ' ' << py;
      }
    }
  }
}

TEST_P(PainterContract, TextureCoordinatesAreExactToAThousandthOnASmoothSurface) {
  Shape shape;
  shape.rectangle({20.3f, 15.7f}, {170.2f, 130.9f});
  draw(*painter_, shape, kWhole);
  for (int y = 17; y < 130; ++y) {
    for (int x = 22; x < 169; ++x) {
      ASSERT_NEAR(uv(x, y).x, x / 256.f, 1e-3);
      ASSERT_NEAR(uv(x, y).y, y / 256.f, 1e-3);
    }
  }
}

TEST_P(PainterContract, NeighbouringTrianglesLeaveNoGap) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> sixteenths(-96, 96);
  Shape shape;
  constexpr int kColumns = 15, kRows = 11, kPitch = 14;
  for (int row = 0; row <= kRows; ++row) {
    for (int column = 0; column <= kColumns; ++column) {
      const bool border = row == 0 || row == kRows || column == 0 || column == kColumns;
      const glm::vec2 jitter =
          border ? glm::vec2{0} : glm::vec2{sixteenths(random), sixteenths(random)} / 16.f;
      shape.vertex(glm::vec2{column * kPitch - 5, row * kPitch - 2} + jitter, {0.5f, 0.5f});
    }
  }
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const int a = row * (kColumns + 1) + column, below = a + kColumns + 1;
      shape.triangle(a, a + 1, below + 1);
      shape.triangle(a, below + 1, below);
    }
  }
  draw(*painter_, shape, kWhole);
  EXPECT_EQ(lit_pixels(), kWidth * kHeight);
}

TEST_P(PainterContract, ARectangleBetweenPixelCentresLightsExactlyThoseInside) {
  Shape shape;
  shape.rectangle({9.5f, 19.5f}, {29.5f, 49.5f});
  draw(*painter_, shape, kWhole);
  EXPECT_EQ(lit_pixels(), 20 * 30);
  EXPECT_NE(surface(10, 20), 0);
  EXPECT_NE(surface(29, 49), 0);
  EXPECT_EQ(surface(9, 20), 0);
  EXPECT_EQ(surface(29, 50), 0);
}

TEST_P(PainterContract, OfTwoHandsTheNearerIsSeenInEitherOrder) {
  Shape near, far(Texture(1, 1, 0xff123456));
  near.rectangle({40, 40}, {90, 90}, 0.5f, 2);
  far.rectangle({10, 10}, {150, 120}, 0.8f, 3);
  for (const bool near_first : {true, false}) {
    const std::array<DrawnHand, 2> hands =
        near_first ? std::array{near.drawn(), far.drawn()} : std::array{far.drawn(), near.drawn()};
    painter_->draw(hands, kWhole);
    EXPECT_EQ(surface(60, 60), surface_id(near_first ? 0 : 1, 2));
    EXPECT_EQ(surface(20, 20), surface_id(near_first ? 1 : 0, 3));
    EXPECT_EQ(colour(60, 60), texel_at(near.texture(), uv(60, 60)));
    EXPECT_EQ(colour(20, 20), 0xff123456u);
  }
}

TEST_P(PainterContract, BetweenTwoHandsThereIsNoLightLeft) {
  Shape left, middle, right;
  left.rectangle({10.5f, 20.5f}, {41.5f, 60.5f});
  middle.rectangle({20.5f, 10.5f}, {140.5f, 100.5f});
  right.rectangle({70.5f, 30.5f}, {101.5f, 80.5f});
  for (const bool left_first : {true, false}) {
    draw(*painter_, middle, kWhole);
    const std::array<DrawnHand, 2> hands = left_first ? std::array{left.drawn(), right.drawn()}
                                                      : std::array{right.drawn(), left.drawn()};
    painter_->draw(hands, kWhole);
    EXPECT_EQ(lit_pixels(), 31 * 40 + 31 * 50);
    for (const int x : {42, 43, 44, 69, 70}) EXPECT_EQ(colour(x, 50), 0u) << x;
    EXPECT_NE(colour(41, 50), 0u);
    EXPECT_NE(colour(71, 50), 0u);
  }
}

TEST_P(PainterContract, AtEqualDepthTheLaterTriangleIsSeen) {
  Shape one;
  one.rectangle({40, 40}, {90, 90}, 0.5f, 2);
  one.rectangle({40, 40}, {90, 90}, 0.5f, 5);
  draw(*painter_, one, kWhole);
  EXPECT_EQ(surface(60, 60), surface_id(0, 5));
  const std::array<DrawnHand, 2> hands{one.drawn(), one.drawn()};
  painter_->draw(hands, kWhole);
  EXPECT_EQ(surface(60, 60), surface_id(1, 5));
}

TEST_P(PainterContract, LightScalesTheColourAndNotWhetherItIsLit) {
  Shape shape(Texture(1, 1, 0xff80c040));
  shape.rectangle({10, 10}, {50, 50});
  shape.dim(0.5f);
  const DrawnHand shaded = shape.drawn(true);
  painter_->draw({&shaded, 1}, kWhole);
  EXPECT_EQ(alpha(20, 20), 255u);
  EXPECT_NEAR(colour(20, 20) & 0xff, 0x20, 1);
  EXPECT_NEAR(colour(20, 20) >> 8 & 0xff, 0x60, 1);
  EXPECT_NEAR(colour(20, 20) >> 16 & 0xff, 0x40, 1);
}

TEST_P(PainterContract, TheNearSideOfAClosedSurfaceIsSeenAlsoInAMirror) {
  for (const float mirror : {1.f, -1.f}) {
    Shape shape;  // a tetrahedron, whose near face (chart 1) hides the three others
    const auto corner = [&](float x, float y, float depth, std::uint8_t chart) {
      return shape.vertex({100 + mirror * x, 75 + y}, {0.5f, 0.5f}, depth, chart);
    };
    const auto face = [&](std::uint8_t chart, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
      const int first = corner(a.x, a.y, a.z, chart), second = corner(b.x, b.y, b.z, chart),
                third = corner(c.x, c.y, c.z, chart);
      shape.triangle(first, second, third);
    };
    const glm::vec3 a{-50, -40, 1}, b{50, -40, 1}, c{0, 50, 1}, back{0, 0, 2};
    face(1, a, b, c);
    face(2, b, a, back);
    face(3, c, b, back);
    face(4, a, c, back);
    draw(*painter_, shape, kWhole);
    EXPECT_EQ(surface(100, 75), 1) << mirror;
    EXPECT_GT(lit_pixels(), 4000) << mirror;
  }
}

TEST_P(PainterContract, DrawingTouchesItsRegionOnly) {
  Shape first, second;
  first.rectangle({0, 0}, {199, 149}, 1, 1);
  second.rectangle({0, 0}, {199, 149}, 1, 2);
  draw(*painter_, first, kWhole);
  const Rect region{37, 29, 101, 90};
  draw(*painter_, second, region);
  for (int y = 0; y < kHeight - 1; ++y) {
    for (int x = 0; x < kWidth - 1; ++x) {
      const bool inside = x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1;
      ASSERT_EQ(surface(x, y), inside ? 2 : 1) << x << ' ' << y;
    }
  }
  expect_consistent();
}

TEST_P(PainterContract, DrawingClearsItsRegionAndNothingElse) {
  Shape shape;
  shape.rectangle({0, 0}, {199, 149});
  draw(*painter_, shape, kWhole);
  painter_->draw({}, {50, 40, 120, 100});
  EXPECT_EQ(lit_pixels({50, 40, 120, 100}), 0);
  EXPECT_EQ(lit_pixels({0, 0, 50, 149}), 50 * 149);
  EXPECT_EQ(lit_pixels({120, 0, 199, 149}), 79 * 149);
  painter_->draw({}, kWhole);
  EXPECT_EQ(lit_pixels(), 0);
  expect_consistent();
}

TEST_P(PainterContract, DarkAreasHaveNoLightAndOthersKeepTheirs) {
  Shape shape;
  shape.rectangle({0, 0}, {199, 149});
  draw(*painter_, shape, kWhole);
  const std::array<Rect, 2> areas{Rect{50, 40, 120, 100}, Rect{-10, 140, 20, 5000}};
  painter_->darken(areas, kWhole);
  const auto colour = painter_->colour();
  for (int y = 0; y < kHeight - 1; ++y)
    for (int x = 0; x < kWidth - 1; ++x) {
      const bool is_dark = (x >= 50 && x < 120 && y >= 40 && y < 100) || (x < 20 && y >= 140);
      ASSERT_EQ(colour.at(x, y) == 0, is_dark) << x << ' ' << y;
    }
  painter_->darken(areas, {0, 0, 0, 0});
}

TEST_P(PainterContract, ARegionBeyondTheImageIsClipped) {
  Shape shape;
  shape.rectangle({-500, -400}, {900, 800});
  draw(*painter_, shape, {-100, -100, 1000, 1000});
  EXPECT_EQ(lit_pixels(), kWidth * kHeight);
  EXPECT_NEAR(uv(100, 75).x, 100 / 256.f, 1e-3);
  draw(*painter_, shape, {5000, 10, 6000, 20});  // outside the image: has no effect
  fill(mask_of(kWidth, kHeight, kWhole), {-10, -10, 1000, 1000});
  EXPECT_EQ(lit_pixels(), kWidth * kHeight);
}

TEST_P(PainterContract, CornersFarBeyondTheImageDoNoHarm) {
  Shape shape;
  const int a = shape.vertex({-25'000, 75}, {0, 0}), b = shape.vertex({25'000, -20'000}, {1, 0}),
            c = shape.vertex({25'000, 20'000}, {1, 1});
  shape.triangle(a, b, c);
  const int nan = shape.vertex({std::nanf(""), 1e30f}, {0, 0});
  shape.triangle(nan, nan, nan);
  draw(*painter_, shape, kWhole);
  EXPECT_EQ(lit_pixels(), kWidth * kHeight);
}

TEST_P(PainterContract, ASmallFilteredPictureShowsTheMeanOfItsLight) {
  Texture checks(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) checks.at(x, y) = (x + y) % 2 ? 0xffffffffu : 0xff000000u;
  Shape shape(checks, true);
  shape.rectangle({10, 10}, {138, 138}, 1, 1, {0, 0}, 2);  // two texels per pixel
  draw(*painter_, shape, kWhole);
  for (int y = 12; y < 130; ++y)
    for (int x = 12; x < 130; ++x)
      ASSERT_NEAR(static_cast<int>(colour(x, y) & 0xff), 188, 1) << x << ' ' << y;
}

TEST_P(PainterContract, BetweenTheTexelsOfAFilteredPictureTheLightIsMixed) {
  Texture edge(2, 1, 0xff000000u);
  edge.at(1, 0) = 0xffffffffu;
  Shape shape(edge, true);
  shape.rectangle({0, 10}, {128, 60}, 1, 1, {0, 0}, 2);  // 64 px per texel
  draw(*painter_, shape, kWhole);
  const auto red = [&](int x) { return static_cast<double>(colour(x, 30) & 0xff); };
  EXPECT_EQ(red(20), 0);
  EXPECT_EQ(red(110), 255);
  for (int x = 33; x < 96; ++x) {
    ASSERT_GE(red(x), red(x - 1));
    ASSERT_NEAR(red(x) * red(x) / 65025, (x - 32) / 64., 0.02) << x;
  }
}

}  // namespace handcast::renderer::test
