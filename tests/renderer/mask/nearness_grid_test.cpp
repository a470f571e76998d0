// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/nearness_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/mask/camera_lookup.hpp"

namespace handcast::renderer {
namespace {

constexpr int kColumns = 5, kRows = 4, kStep_px = 8;

TEST(NearnessGrid, TakesTheNearestVertexAroundEachPoint) {
  NearnessGrid grid(kColumns, kRows, kStep_px);
  const std::array<glm::vec2, 3> vertices{{{16, 8}, {17, 9}, {32, 24}}};
  const std::array<float, 3> depths{0.8f, 0.5f, 1.0f};
  grid.set(vertices, depths, 1.0);
  EXPECT_FLOAT_EQ(grid.points()[1 * kColumns + 2], 1.0f) << "1 / 0.5 - 1 / 1";
  EXPECT_FLOAT_EQ(grid.points()[3 * kColumns + 4], 0.0f);
  EXPECT_FLOAT_EQ(grid.most(), 1.0f);
  EXPECT_FLOAT_EQ(grid.least(), 0.0f);
}

TEST(NearnessGrid, SpreadsWhatItKnowsOverTheScreen) {
  NearnessGrid grid(kColumns, kRows, kStep_px);
  grid.set(std::array{glm::vec2(16, 8)}, std::array{0.5f}, 1.0);
  for (const float point : grid.points()) EXPECT_FLOAT_EQ(point, 1.0f);
}

TEST(NearnessGrid, WithoutVerticesOnTheScreenItIsThePlane) {
  NearnessGrid grid(kColumns, kRows, kStep_px);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  grid.set(std::array{glm::vec2(1e6f, 8), glm::vec2(kNone, 3), glm::vec2(-9, -9)},
           std::array{0.5f, 0.5f, 0.5f}, 1.0);
  for (const float point : grid.points()) EXPECT_EQ(point, 0.0f);
}

/// The rig with a projector that is 15 cm beside the camera.
TEST(ALookupBesideTheCamera, FindsTheMaskOfASurfaceOffThePlane) {
  auto calibration = calib::reference_rig();
  calibration.projector.parallax =
      -(calibration.projector.from_camera * (calibration.camera.matrix() * glm::dvec3(0.15, 0, 0)));
  constexpr double kDepth_m = 0.66;
  constexpr int kEdge_px = 360;
  CameraLookup lookup(calibration);
  Image<std::uint8_t> mask(calibration.camera.width_px, calibration.camera.height_px);
  for (int y = 0; y < mask.height(); ++y)
    std::fill(mask.row(y) + kEdge_px, mask.row(y) + mask.width(), std::uint8_t{255});
  Image<std::uint8_t> out(calibration.projector.width_px, calibration.projector.height_px, 99);
  const std::vector<float> nearness(
      static_cast<std::size_t>(lookup.columns()) * static_cast<std::size_t>(lookup.rows()),
      static_cast<float>(1 / kDepth_m - 1 / calibration.projector.plane_m));
  lookup.resample(mask.view(), {0, 0, out.width(), out.height()}, out.view(), {}, nearness);

  const auto camera_from_projector = glm::inverse(calibration.projector.homography_at(kDepth_m));
  for (int y = 0; y < out.height(); y += 7)
    for (int x = 0; x < out.width(); x += 3) {
      const auto at = camera_from_projector * glm::dvec3(x, y, 1);
      const auto px = calibration.camera.distort(glm::dvec2(at) / at.z);
      const bool is_outside =
          px.x < 1 || px.y < 1 || px.x > mask.width() - 2 || px.y > mask.height() - 2;
      if (is_outside || std::abs(px.x - (kEdge_px - 0.5)) < 0.3) continue;
      ASSERT_EQ(out.at(x, y), px.x > kEdge_px - 0.5 ? 255 : 0) << x << ' ' << y;
    }
  const Rect image{300, 200, 340, 260};
  const auto region = lookup.to_projector(image, nearness[0]);
  const auto corner =
      calibration.projector.pixel_of(calibration.camera.undistort({300, 200}), kDepth_m);
  EXPECT_NEAR(region.x0, corner.x, 4);
  EXPECT_NEAR(region.y0, corner.y, 4);
}

}  // namespace
}  // namespace handcast::renderer
