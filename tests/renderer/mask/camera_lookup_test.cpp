// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/camera_lookup.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace handcast::renderer {
namespace {

calib::Calibration bent() {
  calib::Calibration calibration = calib::reference_rig();
  calibration.camera.k1 = -0.12;
  calibration.camera.k2 = 0.05;
  calibration.camera.p1 = 5e-4;
  return calibration;
}

class Lookup : public ::testing::TestWithParam<bool> {
 protected:
  calib::Calibration calibration = GetParam() ? bent() : calib::reference_rig();
  CameraLookup lookup{calibration};
  Image<std::uint8_t> mask{calibration.camera.width_px, calibration.camera.height_px, 0};
  Image<std::uint8_t> out{calibration.projector.width_px, calibration.projector.height_px, 99};
  const Rect screen{0, 0, calibration.projector.width_px, calibration.projector.height_px};

  glm::dvec2 camera_of(int x, int y) const {
    return calibration.camera.distort(calibration.projector.camera_pixel_of({x, y}));
  }
};
INSTANTIATE_TEST_SUITE_P(Lenses, Lookup, ::testing::Values(false, true),
                         [](const auto& each) { return each.param ? "Bent" : "Reference"; });

/// The edge of a half-plane in camera pixels must be where the exact mapping crosses it.
TEST_P(Lookup, AgreesWithTheExactMappingToATenthOfAPixel) {
  for (const int edge : {150, 360, 600}) {
    for (int y = 0; y < mask.height(); ++y)
      for (int x = 0; x < mask.width(); ++x) mask.at(x, y) = x >= edge ? 255 : 0;
    lookup.resample(mask.view(), screen, out.view());
    for (int y = 0; y < screen.y1; y += 3)
      for (int x = 0; x < screen.x1; ++x) {
        const glm::dvec2 camera = camera_of(x, y);
        if (camera.x < 0 || camera.y < 0 || camera.x > mask.width() - 1 ||
            camera.y > mask.height() - 1)
          continue;
        if (std::abs(camera.x - (edge - 0.5)) < 0.1) continue;
        ASSERT_EQ(out.at(x, y), camera.x > edge - 0.5 ? 255 : 0) << x << ' ' << y;
      }
  }
}

TEST_P(Lookup, EveryPixelOfAPatternIsTheNearestCameraPixel) {
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) mask.at(x, y) = (x / 20 + y / 20) % 2 ? 255 : 0;
  lookup.resample(mask.view(), screen, out.view());
  int wrong = 0, unsure = 0;
  for (int y = 0; y < screen.y1; ++y)
    for (int x = 0; x < screen.x1; ++x) {
      const glm::dvec2 camera = camera_of(x, y);
      const int cx = static_cast<int>(std::lround(camera.x)),
                cy = static_cast<int>(std::lround(camera.y));
      if (cx < 1 || cy < 1 || cx + 1 >= mask.width() || cy + 1 >= mask.height()) continue;
      const bool near_half = std::abs(std::abs(camera.x - cx) - 0.5) < 0.1 ||
                             std::abs(std::abs(camera.y - cy) - 0.5) < 0.1;
      const bool differs = out.at(x, y) != mask.at(cx, cy);
      wrong += differs && !near_half;
      unsure += differs && near_half;
    }
  EXPECT_EQ(wrong, 0);
  EXPECT_LT(unsure, screen.width() * screen.height() / 100);
}

TEST_P(Lookup, ASinglePixelIsNotLostInAUniformBlock) {
  mask.at(300, 250) = 255;
  lookup.resample(mask.view(), screen, out.view());
  int lit = 0;
  for (const auto pixel : out.pixels()) lit += pixel == 255;
  EXPECT_GE(lit, 1);
  EXPECT_LE(lit, 6);
}

TEST_P(Lookup, OnlyTheRegionIsWritten) {
  std::fill(mask.pixels().begin(), mask.pixels().end(), 255);
  const Rect region{403, 301, 530, 402};
  lookup.resample(mask.view(), region, out.view());
  for (int y = 290; y < 420; ++y)
    for (int x = 390; x < 545; ++x) {
      const bool inside = x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1;
      ASSERT_EQ(out.at(x, y), inside ? 255 : 99) << x << ' ' << y;
    }
}

TEST_P(Lookup, BoundsHoldEveryPixel) {
  const Rect camera{200, 150, 420, 380};
  const Rect projector = lookup.to_projector(camera);
  for (int y = 0; y < screen.y1; y += 2)
    for (int x = 0; x < screen.x1; x += 2) {
      const glm::dvec2 at = camera_of(x, y);
      if (at.x < camera.x0 || at.x > camera.x1 - 1 || at.y < camera.y0 || at.y > camera.y1 - 1)
        continue;
      ASSERT_TRUE(x >= projector.x0 && x < projector.x1 && y >= projector.y0 && y < projector.y1)
          << x << ' ' << y;
    }
}

void draw_checks(Image<std::uint8_t>& mask) {
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) mask.at(x, y) = (x / 20 + y / 20) % 2 ? 255 : 0;
}

Similarity similarity(float scale, float turn_rad, glm::vec2 shift) {
  return {scale * std::cos(turn_rad), scale * std::sin(turn_rad), shift};
}

TEST_P(Lookup, AMovedHandReadsAsTheMovedMask) {
  draw_checks(mask);
  for (const glm::ivec2 by :
       {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(-13, 7), glm::ivec2(60, -41)}) {
    Image<std::uint8_t> shifted(mask.width(), mask.height(), 0);
    for (int y = 0; y < mask.height(); ++y)
      for (int x = 0; x < mask.width(); ++x) {
        const int from_x = x + by.x, from_y = y + by.y;
        if (from_x >= 0 && from_y >= 0 && from_x < mask.width() && from_y < mask.height())
          shifted.at(x, y) = mask.at(from_x, from_y);
      }
    Image<std::uint8_t> expected(out.width(), out.height(), 77);
    lookup.resample(shifted.view(), screen, expected.view());
    lookup.resample(mask.view(), screen, out.view(), {1, 0, by});
    // Outside the camera image only the shifted mask ends: those pixels are not compared.
    int compared = 0;
    for (int y = 0; y < screen.y1; ++y)
      for (int x = 0; x < screen.x1; ++x) {
        const glm::dvec2 camera = camera_of(x, y);
        if (camera.x < 0 || camera.y < 0 || camera.x > mask.width() - 1 ||
            camera.y > mask.height() - 1)
          continue;
        ASSERT_EQ(out.at(x, y), expected.at(x, y))
            << x << ' ' << y << " moved by " << by.x << ' ' << by.y;
        ++compared;
      }
    EXPECT_GT(compared, 100000);
  }
}

TEST_P(Lookup, ATurnedAndScaledHandIsTheNearestPixelOfWhereItWas) {
  draw_checks(mask);
  for (const Similarity& move :
       {similarity(1, 0.5f, {140, -120}), similarity(0.6f, -0.2f, {90, 130}),
        similarity(1.8f, 0.1f, {-250, -200})}) {
    lookup.resample(mask.view(), screen, out.view(), move);
    int wrong = 0, compared = 0;
    for (int y = 0; y < screen.y1; ++y)
      for (int x = 0; x < screen.x1; ++x) {
        const glm::vec2 then = move(glm::vec2(camera_of(x, y)));
        const int cx = static_cast<int>(std::lround(then.x)),
                  cy = static_cast<int>(std::lround(then.y));
        if (cx < 1 || cy < 1 || cx + 1 >= mask.width() || cy + 1 >= mask.height()) continue;
        constexpr float kTable_px = 0.2f;  // 0.1 px times the scale
        const bool near_half = std::abs(std::abs(then.x - cx) - 0.5f) < kTable_px ||
                               std::abs(std::abs(then.y - cy) - 0.5f) < kTable_px;
        wrong += out.at(x, y) != mask.at(cx, cy) && !near_half;
        ++compared;
      }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(compared, 100000);
  }
}

/// Blocks that are all hand or all background take a short cut. A region one pixel high contains no
/// whole block.
TEST_P(Lookup, TheShortCutForUniformBlocksChangesNothing) {
  draw_checks(mask);
  mask.at(300, 250) ^= 255;
  Image<std::uint8_t> by_lines(out.width(), out.height(), 77);
  for (const Similarity& move :
       {Similarity(), similarity(1, 0, {17.3f, -9.8f}), similarity(0.7f, 0.3f, {90, -40}),
        similarity(1.9f, -1, {-200, 300})}) {
    lookup.resample(mask.view(), screen, out.view(), move);
    for (int y = 0; y < screen.y1; ++y)
      lookup.resample(mask.view(), {0, y, screen.x1, y + 1}, by_lines.view(), move);
    for (int y = 0; y < screen.y1; ++y)
      for (int x = 0; x < screen.x1; ++x)
        ASSERT_EQ(out.at(x, y), by_lines.at(x, y)) << x << ' ' << y;
  }
}

TEST_P(Lookup, ASmoothMaskIsInterpolatedBetweenTheCameraPixels) {
  draw_checks(mask);
  CameraLookup smooth(calibration, true);
  for (const Similarity& move :
       {Similarity(), similarity(1, 0, {17.3f, -9.8f}), similarity(0.7f, 0.3f, {90, -40})}) {
    smooth.resample(mask.view(), screen, out.view(), move);
    int compared = 0;
    double worst = 0, mean = 0;
    for (int y = 0; y < screen.y1; ++y)
      for (int x = 0; x < screen.x1; ++x) {
        const glm::vec2 then = move(glm::vec2(camera_of(x, y)));
        const glm::ivec2 at(glm::floor(then));
        if (at.x < 0 || at.y < 0 || at.x + 1 >= mask.width() || at.y + 1 >= mask.height()) continue;
        const glm::vec2 part = then - glm::vec2(at);
        const float above = glm::mix(static_cast<float>(mask.at(at.x, at.y)),
                                     static_cast<float>(mask.at(at.x + 1, at.y)), part.x),
                    below = glm::mix(static_cast<float>(mask.at(at.x, at.y + 1)),
                                     static_cast<float>(mask.at(at.x + 1, at.y + 1)), part.x);
        const double off = std::abs(glm::mix(above, below, part.y) - out.at(x, y));
        worst = std::max(worst, off);
        mean += off;
        ++compared;
      }
    EXPECT_LT(worst, 2 * 0.2 * 255);  // 0.2 px of the table, in both directions
    EXPECT_LT(mean / compared, 1);
    EXPECT_GT(compared, 100000);
  }
}

TEST_P(Lookup, TheShortCutsOfASmoothMaskChangeNothing) {
  draw_checks(mask);
  mask.at(300, 250) ^= 255;
  CameraLookup smooth(calibration, true);
  Image<std::uint8_t> by_pixels(out.width(), out.height(), 77);
  for (const Similarity& move :
       {Similarity(), similarity(1, 0, {17.3f, -9.8f}), similarity(1.9f, -1, {-200, 300})}) {
    smooth.resample(mask.view(), screen, out.view(), move);
    for (int x = 0; x < screen.x1; ++x)
      smooth.resample(mask.view(), {x, 0, x + 1, screen.y1}, by_pixels.view(), move);
    for (int y = 0; y < screen.y1; ++y)
      for (int x = 0; x < screen.x1; ++x)
        ASSERT_EQ(out.at(x, y), by_pixels.at(x, y)) << x << ' ' << y;
  }
}

TEST_P(Lookup, AHandThatWasOutsideTheImageIsNotSeen) {
  std::fill(mask.pixels().begin(), mask.pixels().end(), 255);
  for (const Similarity& move :
       {similarity(1, 0, {300, 0}), similarity(1, 0, {-10, -200}), similarity(2, 0.3f, {0, 0}),
        similarity(1, 0, {5000, 0}), similarity(1, 0, {0, -1e9f})}) {
    std::fill(out.pixels().begin(), out.pixels().end(), 99);
    lookup.resample(mask.view(), screen, out.view(), move);
    for (int y = 0; y < screen.y1; ++y)
      for (int x = 0; x < screen.x1; ++x) {
        const glm::vec2 then = move(glm::vec2(camera_of(x, y)));
        const float beyond_px =
            std::max({-then.x, -then.y, then.x - (mask.width() - 1), then.y - (mask.height() - 1)});
        if (std::abs(beyond_px - 0.5f) < 0.3f) continue;
        ASSERT_EQ(out.at(x, y), beyond_px > 0.5f ? 0 : 255) << x << ' ' << y;
      }
  }
}

TEST(CameraLookup, WhereTheCameraSeesNothingThereIsNoHand) {
  calib::Calibration calibration = calib::reference_rig();
  for (int row = 0; row < 3; ++row)
    calibration.projector.from_camera[0][row] *= 0.5;  // the camera sees half of the screen
  CameraLookup lookup(calibration);
  Image<std::uint8_t> mask(calibration.camera.width_px, calibration.camera.height_px, 255),
      out(1024, 768, 99);
  lookup.resample(mask.view(), {0, 0, 1024, 768}, out.view());
  for (int y = 0; y < 768; y += 5)
    for (int x = 0; x < 1024; ++x) {
      const glm::dvec2 camera =
          calibration.camera.distort(calibration.projector.camera_pixel_of({x, y}));
      if (camera.x < -0.7 || camera.x > 719.7 || camera.y < -0.7 || camera.y > 539.7) {
        ASSERT_EQ(out.at(x, y), 0) << x << ' ' << y;
      }
    }
}

}  // namespace
}  // namespace handcast::renderer
