// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/screen_fit.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/calib/solve/screen/rendered_board.hpp"

namespace handcast::calib {
namespace {

using test::bent_camera, test::coaxial_screen, test::kPlane_m, test::screen_beside,
    test::seen_points, test::tilted_board;
using testing::HasSubstr, testing::IsEmpty, testing::Contains;

std::vector<DepthView> views_of(const ProjectorModel& screen, const std::vector<double>& depths_m,
                                double noise_px, unsigned seed = 1) {
  std::vector<DepthView> views;
  for (const double depth_m : depths_m) {
    const auto plane = tilted_board(depth_m);
    views.push_back({seen_points(bent_camera(), screen, plane, noise_px,
                                 seed * 10 + static_cast<unsigned>(views.size())),
                     plane});
  }
  return views;
}

ScreenFit fit_of(const std::vector<DepthView>& views) {
  const auto fit = fit_screen(views, bent_camera(), kPlane_m);
  EXPECT_TRUE(fit) << fit.error().what;
  return fit ? *fit : ScreenFit{};
}

double worst_px(const ScreenFit& fit, const ProjectorModel& truth) {
  return test::worst_px(fit.model, truth, bent_camera());
}

TEST(ProjectorModel, MapsAsItsProjectionMatrixDoes) {
  const auto screen = screen_beside(0.15);
  EXPECT_EQ(screen.from_camera[2][2], 1);
  // The point in front of the camera at kPlane_m is in the middle of the picture.
  const glm::dvec2 middle(359.5, 269.5);
  EXPECT_LT(glm::distance(screen.pixel_of(middle, kPlane_m), {511.5, 383.5}), 1e-9);
  for (const double depth_m : {0.5, 0.73, 1.2}) {
    const glm::dvec2 px(100, 400);
    EXPECT_LT(
        glm::distance(screen.pixel_of(px, depth_m), mapped(screen.homography_at(depth_m), px)),
        1e-9);
  }
  const glm::dvec3 centre_m(0.1, -0.05, 0.2);
  EXPECT_LT(glm::distance(test::screen_from(centre_m).centre_m(bent_camera()), centre_m), 1e-9);
  EXPECT_LT(glm::length(coaxial_screen().centre_m(bent_camera())), 1e-9);
}

TEST(FitScreen, FindsTheTruthExactlyWithoutNoise) {
  for (const double baseline_m : {0.02, 0.15, 0.3}) {
    const auto truth = screen_beside(baseline_m);
    const auto fit = fit_of(views_of(truth, {0.63, 0.73, 0.83}, 0));
    EXPECT_FALSE(fit.coaxial);
    EXPECT_LT(worst_px(fit, truth), 1e-5);
    ASSERT_TRUE(fit.baseline);
    EXPECT_NEAR(fit.baseline->length_mm, 1000 * baseline_m, 1e-3);
    EXPECT_THAT(fit.findings, IsEmpty());
  }
}

TEST(FitScreen, NeedsOnlyTwoBoards) {
  const auto truth = screen_beside(0.15);
  const auto fit = fit_of(views_of(truth, {0.63, 0.83}, 0.3));
  EXPECT_FALSE(fit.coaxial);
  EXPECT_LT(worst_px(fit, truth), 0.3);
  EXPECT_NEAR(fit.baseline->length_mm, 150, 3 * fit.baseline->interval_mm);
}

TEST(FitScreen, ChoosesTheCoaxialModelForACoaxialProjector) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto fit = fit_of(views_of(coaxial_screen(), {0.63, 0.73, 0.83}, 0.5, seed));
    EXPECT_TRUE(fit.coaxial) << seed;
    EXPECT_TRUE(fit.parallax_observable);
    EXPECT_FALSE(fit.baseline);
    EXPECT_LT(worst_px(fit, coaxial_screen()), 0.15);
    EXPECT_THAT(fit.findings, IsEmpty());
  }
}

TEST(FitScreen, SaysThatOneDepthDoesNotTellTheParallax) {
  const auto truth = screen_beside(0.15);
  for (const std::vector<double>& depths_m : {std::vector{0.73}, {0.73, 0.73}, {0.73, 0.735}}) {
    const auto fit = fit_of(views_of(truth, depths_m, 0.2));
    EXPECT_TRUE(fit.coaxial);
    EXPECT_FALSE(fit.parallax_observable);
    EXPECT_FALSE(fit.baseline);
    EXPECT_THAT(fit.findings, Contains(HasSubstr("it cannot be told whether the projector")));
    EXPECT_NEAR(fit.depths_m.x, 0.68, 0.03);
    EXPECT_NEAR(fit.depths_m.y, 0.79, 0.03);
    EXPECT_LT(fit.residual.p95, depths_m.size() == 1 ? 0.6 : 2);
  }
}

TEST(FitScreen, SaysThatTheDepthsAreFew) {
  std::vector<DepthView> views;
  for (const double depth_m : {0.71, 0.75}) {
    const auto plane = tilted_board(depth_m, 0);
    views.push_back({seen_points(bent_camera(), screen_beside(0.15), plane, 0.2, 1), plane});
  }
  const auto fit = fit_of(views);
  EXPECT_FALSE(fit.coaxial);
  EXPECT_THAT(fit.findings, Contains(HasSubstr("extrapolated")));
}

TEST(FitScreen, IsNotMovedByOutliers) {
  const auto truth = screen_beside(0.15);
  auto views = views_of(truth, {0.63, 0.73, 0.83}, 0.3);
  for (auto& view : views) test::spoil(view.points, 0.2, 3);
  const auto fit = fit_of(views);
  EXPECT_LT(worst_px(fit, truth), 0.3);
  EXPECT_NEAR(fit.inlier_share, 0.8, 0.03);
}

TEST(FitScreen, NamesTheViewWhoseBoardHasAWrongPose) {
  const auto truth = screen_beside(0.15);
  auto views = views_of(truth, {0.6, 0.65, 0.7, 0.75, 0.8, 0.85}, 0.2);
  views[3].plane = tilted_board(0.78);
  const auto fit = fit_of(views);
  EXPECT_THAT(fit.findings, Contains(HasSubstr("View 4 is off by")));
}

TEST(FitScreen, StatesItsErrorsOnViewsThatWereLeftOut) {
  const auto truth = screen_beside(0.05);
  const auto fit = fit_of(views_of(truth, {0.63, 0.73, 0.83}, 0.3));
  EXPECT_NEAR(fit.held_out_full.median, 0.3 * 1.1774, 0.06);
  // 5 mm of 50 at 0.1 m of 0.73.
  EXPECT_GT(fit.held_out_coaxial.p95, 5);
}

TEST(FitScreen, NamesTheViewThatCannotBeUsed) {
  auto views = views_of(coaxial_screen(), {0.63, 0.73}, 0.1);
  views[1].points.resize(3);
  EXPECT_THAT(fit_screen(views, bent_camera(), kPlane_m).error().what,
              HasSubstr("view 2: only 3 points"));
  views = views_of(coaxial_screen(), {0.63, 0.73}, 0.1);
  views[0].plane = {0, 0, 1, 0.7};
  EXPECT_THAT(fit_screen(views, bent_camera(), kPlane_m).error().what,
              HasSubstr("view 1: the board is not in front"));
  views[0].plane = {0, 0, 0, std::nan("")};
  EXPECT_FALSE(fit_screen(views, bent_camera(), kPlane_m));
  EXPECT_THAT(fit_screen({}, bent_camera(), kPlane_m).error().what, HasSubstr("no view"));
}

TEST(FitScreen, GivesIntervalsOfTheBaselineThatHoldTheTruth) {
  constexpr int kSeeds = 100;
  const auto truth = screen_beside(0.15);
  int inside = 0;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const auto fit = fit_of(views_of(truth, {0.63, 0.73, 0.83}, 0.5, seed));
    ASSERT_TRUE(fit.baseline);
    inside += std::abs(fit.baseline->length_mm - 150) <= fit.baseline->interval_mm;
  }
  std::printf("  %d %% of the baselines lie in their intervals\n", inside * 100 / kSeeds);
  EXPECT_GE(inside, 0.88 * kSeeds);
  EXPECT_LT(inside, kSeeds);
}

}  // namespace
}  // namespace handcast::calib
