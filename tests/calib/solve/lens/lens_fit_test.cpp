// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/lens_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "tests/calib/solve/lens/synthetic_views.hpp"

namespace handcast::calib {
namespace {

using testing::HasSubstr;

/// A usual lens, whose principal point is not the middle of the image.
CameraModel usual_lens() {
  CameraModel camera;
  camera.fx_px = 1162, camera.fy_px = 1158, camera.cx_px = 352, camera.cy_px = 275;
  camera.k1 = -0.28, camera.k2 = 0.15;
  return camera;
}

Result<LensFit> fit(const std::vector<BoardView>& views) { return fit_lens(views, 720, 540); }

std::string complaint(const std::vector<BoardView>& views) {
  const auto fitted = fit(views);
  if (fitted) return "";
  EXPECT_EQ(fitted.error().code, Errc::bad_data);
  return fitted.error().what;
}

std::vector<std::size_t> rejected(const LensFit& fitted) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < fitted.views.size(); ++i)
    if (!fitted.views[i].rejected.empty()) places.push_back(i);
  return places;
}

TEST(FitLens, FindsTheLensFromNoisyViews) {
  const auto truth = usual_lens();
  std::vector<double> off_px;
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    const auto fitted = fit(show({}, truth, seed));
    ASSERT_TRUE(fitted) << fitted.error().what;
    EXPECT_NEAR(fitted->camera.fx_px / truth.fx_px, 1, 0.003);
    EXPECT_NEAR(fitted->camera.fy_px / truth.fy_px, 1, 0.003);
    EXPECT_EQ(fitted->camera.width_px, 720);
    EXPECT_EQ(fitted->camera.height_px, 540);
    const double noise_px = 0.2 * std::numbers::sqrt2;
    EXPECT_NEAR(fitted->rms_px, noise_px, 0.03);
    EXPECT_NEAR(fitted->held_out_px, noise_px, 0.03);
    EXPECT_GT(fitted->held_out_px, fitted->rms_px);
    off_px.push_back(reprojection_px(fitted->camera, truth));
  }
  std::ranges::sort(off_px);
  EXPECT_LT(off_px[2], 0.3) << "the median";
}

TEST(FitLens, IsExactWithoutNoise) {
  const auto truth = reference_rig().camera;
  const auto fitted = fit(show({.noise_px = 0}, truth, 1));
  ASSERT_TRUE(fitted) << fitted.error().what;
  EXPECT_EQ(fitted->distortion, Distortion::k3);
  EXPECT_NEAR(fitted->camera.fx_px, truth.fx_px, 0.01);
  EXPECT_NEAR(fitted->camera.cx_px, truth.cx_px, 0.01);
  EXPECT_LT(reprojection_px(fitted->camera, truth), 0.001);
}

TEST(FitLens, FindsTheMinimumThatOpenCvFinds) {
  const auto views = show({}, usual_lens(), 4);
  const auto fitted = fit(views);
  ASSERT_TRUE(fitted);
  ASSERT_EQ(fitted->distortion, Distortion::k2);
  std::vector<std::vector<cv::Point3f>> board_m(views.size());
  std::vector<std::vector<cv::Point2f>> image_px(views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t j = 0; j < views[i].ids.size(); ++j) {
      const auto& m = views[i].board_m[j];
      board_m[i].emplace_back(static_cast<float>(m.x), static_cast<float>(m.y), 0.F);
      const auto& px = views[i].image_px[j];
      image_px[i].emplace_back(static_cast<float>(px.x), static_cast<float>(px.y));
    }
  cv::Mat matrix, lens;
  const double rms_px =
      cv::calibrateCamera(board_m, image_px, {720, 540}, matrix, lens, cv::noArray(), cv::noArray(),
                          cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K3);
  EXPECT_NEAR(fitted->camera.fx_px, matrix.at<double>(0, 0), 0.02);
  EXPECT_NEAR(fitted->camera.cy_px, matrix.at<double>(1, 2), 0.02);
  EXPECT_NEAR(fitted->camera.k2, lens.at<double>(1), 1e-3);
  EXPECT_NEAR(fitted->rms_px, rms_px, 1e-4);
}

TEST(FitLens, TakesTheSimplestDistortionThatIsEnough) {
  auto camera = usual_lens();
  const auto chosen = [&camera] {
    const auto fitted = fit(show({}, camera, 5));
    return fitted ? words_of(Distortion{})[static_cast<std::size_t>(fitted->distortion)] : "none?";
  };
  EXPECT_EQ(chosen(), "k1 k2");
  camera.k2 = 0;
  EXPECT_EQ(chosen(), "k1");
  camera.k1 = 0;
  EXPECT_EQ(chosen(), "none");
  camera.k1 = -0.28, camera.k2 = 0.15, camera.p1 = 0.004, camera.p2 = -0.004;
  EXPECT_EQ(chosen(), "k1 k2 p1 p2");
  camera.k3 = 5;
  EXPECT_EQ(chosen(), "k1 k2 p1 p2 k3");
}

TEST(FitLens, NoiseIsRarelyTakenForDistortion) {
  const auto camera = CameraModel{};
  int simple = 0;
  for (unsigned seed = 30; seed < 45; ++seed) {
    const auto fitted = fit(show({.views = 8}, camera, seed));
    ASSERT_TRUE(fitted);
    simple += fitted->distortion == Distortion::none;
  }
  EXPECT_GE(simple, 13);
}

TEST(FitLens, SaysWhatEachModelPredicts) {
  const auto fitted = fit(show({}, usual_lens(), 6));
  ASSERT_TRUE(fitted);
  EXPECT_GT(fitted->held_out_of_px[0], 2 * fitted->held_out_px) << "no distortion is not enough";
  EXPECT_EQ(fitted->held_out_of_px[static_cast<std::size_t>(fitted->distortion)],
            fitted->held_out_px);
}

TEST(FitLens, FindsWhereTheBoardsWere) {
  const auto truth = usual_lens();
  const Board board{BoardKind::charuco, 10, 7, 20};
  std::mt19937 random(1);
  auto views = show({}, truth, 7);
  const auto pose = held(board, {0.01, 0.02, 0.4}, {0.3, -0.2});
  views.push_back(view_of(board, truth, pose, 0.2, random));
  const auto fitted = fit(views);
  ASSERT_TRUE(fitted);
  const auto& found = fitted->views.back().camera_from_board;
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_LT(glm::distance(glm::dvec3(found[axis]), glm::dvec3(pose[axis])), 0.01);
  EXPECT_NEAR(found[3].z, pose[3].z, 0.002);
}

TEST(FitLens, AViewOfABoardThatMovedIsLeftOutAndNamed) {
  auto views = show({}, usual_lens(), 8);
  std::mt19937 random(1);
  std::normal_distribution<double> blur(0, 1.5);
  for (auto& px : views[3].image_px) px += glm::dvec2(blur(random), blur(random));
  const auto fitted = fit(views);
  ASSERT_TRUE(fitted) << fitted.error().what;
  EXPECT_THAT(rejected(*fitted), testing::ElementsAre(3));
  EXPECT_THAT(fitted->views[3].rejected, HasSubstr("far above"));
  EXPECT_GT(fitted->views[3].rms_px, 1);
  EXPECT_LT(fitted->rms_px, 0.35);
}

TEST(FitLens, ViewsWhoseCornersWereMistakenAreLeftOutAndNamed) {
  auto views = show({}, usual_lens(), 9);
  std::swap(views[1].image_px.front(), views[1].image_px.back());
  views[5].image_px[2].x = std::numeric_limits<double>::quiet_NaN();
  views[7].ids.resize(4), views[7].image_px.resize(4), views[7].board_m.resize(4);
  views[9] = {};
  views[11].board_m.pop_back();
  const auto fitted = fit(views);
  ASSERT_TRUE(fitted) << fitted.error().what;
  EXPECT_THAT(rejected(*fitted), testing::ElementsAre(1, 5, 7, 9, 11));
  EXPECT_THAT(fitted->views[1].rejected, HasSubstr("mistaken"));
  EXPECT_THAT(fitted->views[5].rejected, HasSubstr("not numbers"));
  EXPECT_THAT(fitted->views[7].rejected, HasSubstr("4 corners"));
  EXPECT_LT(fitted->rms_px, 0.35);
}

TEST(FitLens, GoodViewsAreKept) {
  int left_out = 0;
  for (unsigned seed = 20; seed < 24; ++seed) {
    const auto fitted = fit(show({}, usual_lens(), seed));
    ASSERT_TRUE(fitted);
    left_out += static_cast<int>(rejected(*fitted).size());
  }
  EXPECT_LE(left_out, 1);
}

TEST(FitLens, TooFewViewsAreAnError) {
  EXPECT_THAT(complaint({}), HasSubstr("from 0 views of the board; take at least 6"));
  EXPECT_THAT(complaint(show({.views = 5}, usual_lens(), 1)), HasSubstr("take at least 6"));
  auto views = show({.views = 7}, usual_lens(), 1);
  views[0] = views[1] = {};
  EXPECT_THAT(complaint(views), HasSubstr("from 5 views"));
}

TEST(FitLens, ABoardThatWasNeverTiltedIsAnError) {
  for (const double noise_px : {0., 0.001, 0.2, 0.5})
    EXPECT_THAT(complaint(show({.noise_px = noise_px, .tilt_rad = 0}, usual_lens(), 1)),
                HasSubstr("parallel to the image in all views; tilt the board"));
}

TEST(FitLens, OneViewManyTimesIsAnError) {
  const auto view = show({}, usual_lens(), 1).front();
  EXPECT_NE(complaint(std::vector<BoardView>(12, view)), "");
}

TEST(FitLens, ABoardOnlyInTheMiddleIsAnError) {
  const Board small{BoardKind::charuco, 10, 7, 5};
  auto camera = usual_lens();
  std::vector<BoardView> views;
  std::mt19937 random(1);
  for (int i = 0; i < 12; ++i)
    views.push_back(view_of(small, camera,
                            held(small, {0, 0, 0.4}, {0.4 * std::sin(i), 0.4 * std::cos(i)}), 0.2,
                            random));
  EXPECT_THAT(complaint(views), HasSubstr("hold it also at the edges"));
}

TEST(FitLens, ViewsThatContradictEachOtherAreAnError) {
  auto views = show({}, usual_lens(), 10);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < views.size(); i += 2) {
    std::normal_distribution<double> bent(0, 1 + static_cast<double>(i));
    for (auto& px : views[i].image_px) px += glm::dvec2(bent(random), bent(random));
  }
  EXPECT_NE(complaint(views), "");
}

TEST(FitLens, TheIntervalsHoldTheTruthAboutAsOftenAsTheySay) {
  const auto truth = usual_lens();
  int inside = 0, all = 0;
  for (unsigned seed = 1; seed <= 15; ++seed) {
    const auto fitted = fit(show({.views = 10}, truth, seed));
    ASSERT_TRUE(fitted) << fitted.error().what;
    const std::array values{truth.fx_px, truth.fy_px, truth.cx_px, truth.cy_px};
    for (std::size_t i = 0; i < values.size(); ++i, ++all)
      inside += values[i] > fitted->spreads[i].low && values[i] < fitted->spreads[i].high;
  }
  EXPECT_GE(inside, all * 85 / 100) << "of " << all;
}

TEST(FitLens, MoreViewsGiveNarrowerIntervals) {
  const auto few = fit(show({.views = 10}, usual_lens(), 11));
  const auto many = fit(show({.views = 40}, usual_lens(), 11));
  ASSERT_TRUE(few && many);
  EXPECT_LT(many->spreads[0].deviation, 0.7 * few->spreads[0].deviation);
  EXPECT_GT(many->spreads[0].deviation, 0.1 * few->spreads[0].deviation);
  EXPECT_LT(many->spreads[0].low, many->camera.fx_px);
  EXPECT_GT(many->spreads[0].high, many->camera.fx_px);
}

TEST(FitLens, GivesTheSameForTheSameViews) {
  const auto views = show({}, usual_lens(), 12);
  const auto one = fit(views), other = fit(views);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->camera.fx_px, other->camera.fx_px);
  EXPECT_EQ(one->spreads[4].low, other->spreads[4].low);
}

}  // namespace
}  // namespace handcast::calib
