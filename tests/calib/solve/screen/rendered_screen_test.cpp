// SPDX-License-Identifier: Apache-2.0
// From the camera's images to the model: what the whole way costs in accuracy.
#include <gtest/gtest.h>

#include "calib/solve/screen/screen_fit.hpp"
#include "tests/calib/solve/screen/rendered_board.hpp"

namespace handcast::calib {
namespace {

using test::bent_camera, test::kPlane_m, test::tilted_board;

constexpr double kGood_px = 0.5;

/// The points that are decoded from the images of a board.
std::vector<Correspondence> decoded(const ProjectorModel& screen, double depth_m,
                                    const test::Scene& scene = {}) {
  const GrayCode code(test::kProjectorWidth_px, test::kProjectorHeight_px);
  test::RenderedBoard board(screen, tilted_board(depth_m), scene);
  const auto read = code.decode(test::shoot(code, board).views());
  EXPECT_TRUE(read) << read.error().what;
  return read ? read->points : std::vector<Correspondence>();
}

std::vector<DepthView> views_of(const ProjectorModel& screen, const std::vector<double>& depths_m,
                                const test::Scene& scene = {}) {
  std::vector<DepthView> views;
  for (const double depth_m : depths_m)
    views.push_back({decoded(screen, depth_m, scene), tilted_board(depth_m)});
  return views;
}

TEST(RenderedScreen, OneBoardGivesTheHomographyOfACoaxialProjectorAtAllDepths) {
  const auto truth = test::coaxial_screen();
  auto points = decoded(truth, kPlane_m);
  const auto worst_of = [&] {
    const auto fit = fit_homography(points, bent_camera());
    EXPECT_TRUE(fit) << fit.error().what;
    return fit ? test::worst_px({fit->projector_from_camera, glm::dvec3(0), kPlane_m}, truth,
                                bent_camera())
               : 1e9;
  };
  const double worst_px = worst_of();
  test::spoil(points, 0.2, 1);
  const double spoilt_px = worst_of();
  std::printf("  worst error %.3f px, with 20 %% outliers %.3f px\n", worst_px, spoilt_px);
  EXPECT_LE(worst_px, kGood_px);
  EXPECT_LE(spoilt_px, kGood_px);
}

TEST(RenderedScreen, HalfOfABoardIsEnoughForItsHalfOfTheImage) {
  const auto truth = test::coaxial_screen();
  const auto fit = fit_homography(decoded(truth, kPlane_m, {.board_right_m = 0}), bent_camera());
  ASSERT_TRUE(fit) << fit.error().what;
  const ProjectorModel model{fit->projector_from_camera, glm::dvec3(0), kPlane_m};
  double worst_px = 0;
  for (int y = 0; y < 540; y += 20)
    for (int x = 0; x < 360; x += 20)
      worst_px =
          std::max(worst_px, glm::distance(model.pixel_of({x, y}, 1), truth.pixel_of({x, y}, 1)));
  std::printf("  worst error %.3f px in this half, %.3f px in both\n", worst_px,
              test::worst_px(model, truth, bent_camera()));
  EXPECT_LE(worst_px, kGood_px);
}

TEST(RenderedScreen, ThreeBoardsShowThatAProjectorIsCoaxial) {
  const auto fit =
      fit_screen(views_of(test::coaxial_screen(), {0.63, 0.73, 0.83}), bent_camera(), kPlane_m);
  ASSERT_TRUE(fit) << fit.error().what;
  const double worst_px = test::worst_px(fit->model, test::coaxial_screen(), bent_camera());
  std::printf("  worst error %.3f px, held out p95 coaxial %.3f px, full %.3f px\n", worst_px,
              fit->held_out_coaxial.p95, fit->held_out_full.p95);
  EXPECT_TRUE(fit->coaxial);
  EXPECT_LE(worst_px, kGood_px);
}

TEST(RenderedScreen, ThreeBoardsGiveAProjectorBesideTheCamera) {
  const auto truth = test::screen_beside(0.15);
  const auto fit = fit_screen(views_of(truth, {0.63, 0.73, 0.83}), bent_camera(), kPlane_m);
  ASSERT_TRUE(fit) << fit.error().what;
  const double worst_px = test::worst_px(fit->model, truth, bent_camera());
  ASSERT_TRUE(fit->baseline);
  std::printf("  worst error %.3f px, baseline %.2f +- %.2f mm\n", worst_px,
              fit->baseline->length_mm, fit->baseline->interval_mm);
  EXPECT_FALSE(fit->coaxial);
  EXPECT_LE(worst_px, kGood_px);
  EXPECT_NEAR(fit->baseline->length_mm, 150, 1);
}

TEST(RenderedScreen, APrintedOverexposedBoardWillDo) {
  const auto truth = test::screen_beside(0.15);
  const auto fit = fit_screen(views_of(truth, {0.63, 0.83}, {.contrast = 250, .squares_m = 0.03}),
                              bent_camera(), kPlane_m);
  ASSERT_TRUE(fit) << fit.error().what;
  const double worst_px = test::worst_px(fit->model, truth, bent_camera());
  std::printf("  worst error %.3f px\n", worst_px);
  EXPECT_LE(worst_px, kGood_px);
}

}  // namespace
}  // namespace handcast::calib
