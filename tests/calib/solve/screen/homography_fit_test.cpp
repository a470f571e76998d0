// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/homography_fit.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "calib/solve/screen/resampling.hpp"
#include "tests/calib/solve/screen/rendered_board.hpp"

namespace handcast::calib {
namespace {

using test::bent_camera, test::coaxial_screen, test::seen_points, test::tilted_board;
using testing::HasSubstr, testing::IsEmpty, testing::Contains;

std::vector<Correspondence> points(double noise_px, unsigned seed = 1) {
  return seen_points(bent_camera(), coaxial_screen(), tilted_board(test::kPlane_m), noise_px, seed);
}

double worst_px(const HomographyFit& fit) {
  return test::worst_px({fit.projector_from_camera, glm::dvec3(0), test::kPlane_m},
                        coaxial_screen(), bent_camera());
}

std::string error_of(const std::vector<Correspondence>& points) {
  const auto fit = fit_homography(points, bent_camera());
  EXPECT_FALSE(fit);
  return fit ? "" : fit.error().what;
}

TEST(HomographyOfCorners, MapsEachCornerToItsPlace) {
  const std::array<glm::dvec2, 4> from{{{10, 20}, {700, 5}, {690, 530}, {30, 500}}};
  const std::array<glm::dvec2, 4> to{{{0, 0}, {1023, 0}, {1023, 767}, {0, 767}}};
  const auto homography = homography_of_corners(from, to);
  EXPECT_EQ(homography[2][2], 1);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT(glm::distance(mapped(homography, from[i]), to[i]), 1e-9);
}

TEST(HomographyOfCorners, IsNotFiniteForCornersOnALine) {
  const auto homography =
      homography_of_corners({{{0, 0}, {1, 1}, {2, 2}, {5, 0}}}, {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  EXPECT_FALSE(std::isfinite(homography[0][0]));
}

TEST(FitHomography, FindsTheTruthExactlyWithoutNoise) {
  const auto fit = fit_homography(points(0), bent_camera());
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_LT(worst_px(*fit), 1e-6);
  EXPECT_EQ(fit->inlier_share, 1);
  EXPECT_LT(fit->held_out.p95, 1e-6);
  EXPECT_THAT(fit->findings, IsEmpty());
  EXPECT_FALSE(fit->mirrored);
}

TEST(FitHomography, AveragesNoiseAndStatesIt) {
  const auto fit = fit_homography(points(0.5), bent_camera());
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_LT(worst_px(*fit), 0.15);
  EXPECT_NEAR(fit->residual.median, 0.5 * 1.1774, 0.05);
  EXPECT_NEAR(fit->held_out.median, fit->residual.median, 0.02);
  EXPECT_GT(fit->inlier_share, 0.99);
}

TEST(FitHomography, IsNotMovedByOutliers) {
  for (const double share : {0.05, 0.2, 0.35}) {
    auto spoilt = points(0.3);
    test::spoil(spoilt, share, 5);
    const auto fit = fit_homography(spoilt, bent_camera());
    ASSERT_TRUE(fit) << fit.error().what;
    EXPECT_LT(worst_px(*fit), 0.15);
    EXPECT_NEAR(fit->inlier_share, 1 - share, 0.03);
    EXPECT_EQ(fit->findings.size(), share > 0.1 ? 1u : 0u);
  }
}

TEST(FitHomography, RefusesPointsThatDoNotAgree) {
  auto spoilt = points(0.3);
  test::spoil(spoilt, 0.93, 5);
  EXPECT_THAT(error_of(spoilt),
              testing::MatchesRegex("only [0-9]+ % of the points agree.*flat.*move.*"));
}

TEST(FitHomography, RefusesABoardThatIsBent) {
  const auto bent = [](const CameraModel& camera) {
    std::vector<Correspondence> all;
    const auto screen = test::screen_beside(0.15);
    for (int y = 10; y < 540; y += 20)
      for (int x = 10; x < 720; x += 20) {
        const auto px = camera.undistort(glm::dvec2(x, y));
        const double depth_m = 0.6 + 0.25 * std::sin(x / 100.);
        all.push_back({{x, y}, screen.pixel_of(px, depth_m), 1});
      }
    return all;
  };
  EXPECT_THAT(error_of(bent(bent_camera())), HasSubstr("is the board flat"));
}

TEST(FitHomography, RefusesTooFewPointsAndPointsOnALine) {
  EXPECT_THAT(error_of({}), HasSubstr("only 0 points"));
  auto few = points(0);
  few.resize(19);
  EXPECT_THAT(error_of(few), HasSubstr("only 19 points"));
  std::vector<Correspondence> line;
  for (int x = 0; x < 700; ++x) line.push_back({{x, 100 + 0.5 * x}, {x, x}, 1});
  EXPECT_THAT(error_of(line), HasSubstr("on a line"));
  EXPECT_THAT(error_of(std::vector<Correspondence>(200, {{5, 5}, {7, 7}, 1})),
              HasSubstr("one spot"));
}

TEST(FitHomography, RefusesAGoodLineWithAFewOutliersBesideIt) {
  std::vector<Correspondence> line;
  for (int x = 0; x < 700; ++x) line.push_back({{x, 300}, {1.4 * x, 400}, 1});
  for (int i = 0; i < 70; ++i) line.push_back({{10 * i, 7 * i}, {900 - 9 * i, 37 * i % 700}, 1});
  EXPECT_THAT(error_of(line), HasSubstr("on a line"));
}

TEST(FitHomography, LeavesOutPointsThatAreNoNumbers) {
  auto broken = points(0.1);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < broken.size(); i += 10) broken[i].projector_px.x = kNan;
  for (std::size_t i = 1; i < broken.size(); i += 20) broken[i].camera_px.y = kNan;
  for (std::size_t i = 2; i < broken.size(); i += 20) broken[i].sigma_px = 0;
  const auto fit = fit_homography(broken, bent_camera());
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_LT(worst_px(*fit), 0.05);
  EXPECT_NEAR(fit->inlier_share, 0.8, 0.01);
}

TEST(FitHomography, SaysThatPointsInOnePlaceDoNotTellTheCorners) {
  auto clustered = points(0.3);
  std::erase_if(clustered, [](const auto& point) {
    return point.camera_px.x > 150 || point.camera_px.y > 200;
  });
  const auto fit = fit_homography(clustered, bent_camera());
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_THAT(fit->findings, Contains(HasSubstr("cover only")));
  EXPECT_THAT(fit->findings, Contains(HasSubstr("known only to")));
  EXPECT_GT(fit->corner_interval_px[2].x, 2);
  EXPECT_LT(fit->corner_interval_px[0].x, 1);
}

TEST(FitHomography, SaysThatThePictureIsMirrored) {
  auto mirrored = points(0.1);
  for (auto& point : mirrored) point.projector_px.x = 1023 - point.projector_px.x;
  const auto fit = fit_homography(mirrored, bent_camera());
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_TRUE(fit->mirrored);
  EXPECT_THAT(fit->findings, Contains(HasSubstr("mirrored")));
}

TEST(FitHomography, SaysThatTheLensIsNotCalibrated) {
  auto straight = bent_camera();
  straight.k1 = 0;
  const auto fit = fit_homography(points(0.1), straight);
  ASSERT_TRUE(fit) << fit.error().what;
  std::printf("  residual p95 %.2f px, held out %.2f px\n", fit->residual.p95, fit->held_out.p95);
  EXPECT_THAT(fit->findings, Contains(HasSubstr("the lens calibrated")));
}

TEST(FitHomography, WeighsPointsByTheirAccuracy) {
  auto mixed = points(0.1);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 3);
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    mixed[i].sigma_px = i % 3 ? 3 : 0.1;
    if (i % 3) mixed[i].projector_px += glm::dvec2(noise(random), noise(random));
  }
  const auto fit = fit_homography(mixed, bent_camera());
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_GT(fit->inlier_share, 0.95);
  EXPECT_LT(worst_px(*fit), 0.08);
}

TEST(FitHomography, GivesIntervalsThatHoldTheTruthInAbout95Of100) {
  constexpr int kSeeds = 200;
  const auto truth = corners_in_camera(coaxial_screen(), {1024, 768});
  int inside = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    auto seen = points(0.5, static_cast<unsigned>(seed));
    test::spoil(seen, 0.05, static_cast<unsigned>(seed));
    const auto fit = fit_homography(seen, bent_camera());
    ASSERT_TRUE(fit) << fit.error().what;
    for (std::size_t corner = 0; corner < 4; ++corner)
      for (int axis = 0; axis < 2; ++axis)
        inside += std::abs(fit->corners_px[corner][axis] - truth[corner][axis]) <=
                  fit->corner_interval_px[corner][axis];
  }
  const double coverage = inside / (8. * kSeeds);
  std::printf("  %.1f %% of the corners' coordinates lie in their intervals\n", 100 * coverage);
  EXPECT_GE(coverage, 0.9);
  EXPECT_LE(coverage, 0.99);
}

}  // namespace
}  // namespace handcast::calib
