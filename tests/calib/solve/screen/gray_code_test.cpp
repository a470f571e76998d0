// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/gray_code.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "ipc/base/statistics.hpp"
#include "tests/calib/solve/screen/rendered_board.hpp"

namespace handcast::calib {
namespace {

using test::RenderedBoard, test::Scene, test::shoot;
using testing::HasSubstr;

const GrayCode& code() {
  static const GrayCode code(test::kProjectorWidth_px, test::kProjectorHeight_px);
  return code;
}

RenderedBoard board(const Scene& scene = {}) {
  return {test::coaxial_screen(), test::tilted_board(test::kPlane_m), scene};
}

/// What the camera sees of a white board.
const test::Shots& shots() {
  static const auto shots = [] {
    auto seen = board();
    return shoot(code(), seen);
  }();
  return shots;
}

/// Distances of the decoded points from where they truly are, projector px.
std::vector<double> errors_px(const GrayDecoding& decoded) {
  std::vector<double> errors;
  for (const auto& point : decoded.points) {
    const auto truth =
        test::coaxial_screen().pixel_of(test::bent_camera().undistort(point.camera_px), 1);
    errors.push_back(glm::distance(truth, point.projector_px));
  }
  return errors;
}

TEST(GrayCode, NeighbouringCellsDifferInOnePatternAndAllCellsDiffer) {
  const GrayCode small(20, 12, 2);  // cells of one pixel
  std::vector<std::vector<std::uint8_t>> pictures;
  for (int i = 0; i < small.patterns(); i += 2)
    small.draw(i, pictures.emplace_back(20 * 12).data());
  std::set<std::string> seen;
  for (int pixel = 0; pixel < 20 * 12; ++pixel) {
    std::string word;
    int changes = 0;
    for (const auto& picture : pictures) {
      word += picture[static_cast<std::size_t>(pixel)] ? '1' : '0';
      if (pixel % 20)
        changes += picture[static_cast<std::size_t>(pixel)] !=
                   picture[static_cast<std::size_t>(pixel - 1)];
    }
    EXPECT_EQ(changes, pixel % 20 ? 1 : 0) << pixel;
    seen.insert(word);
  }
  EXPECT_EQ(seen.size(), 20u * 12);
}

TEST(GrayCode, EachPatternIsFollowedByItsInverse) {
  std::vector<std::uint8_t> picture(20 * 12), inverse(20 * 12);
  const GrayCode small(20, 12, 4);
  for (int i = 0; i < small.patterns(); i += 2) {
    small.draw(i, picture.data());
    small.draw(i + 1, inverse.data());
    for (std::size_t pixel = 0; pixel < picture.size(); ++pixel)
      EXPECT_EQ(picture[pixel] + inverse[pixel], 255);
  }
}

TEST(GrayCode, FinestStripesAreAsWideAsAsked) {
  for (const int finest_px : {2, 4, 8}) {
    const GrayCode wide(64, 8, finest_px);
    int narrowest = 64;
    std::vector<std::uint8_t> picture(64 * 8);
    for (int i = 2; i < wide.patterns(); ++i) {
      wide.draw(i, picture.data());
      int begin = -64;  // the first stripe begins outside the picture
      for (int x = 1; x < 64; ++x)
        if (picture[static_cast<std::size_t>(x)] != picture[static_cast<std::size_t>(x - 1)]) {
          narrowest = std::min(narrowest, x - begin);
          begin = x;
        }
    }
    EXPECT_EQ(narrowest, finest_px);
  }
}

TEST(GrayCode, FindsTheProjectorToAFractionOfAPixel) {
  const auto decoded = code().decode(shots().views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  const auto errors = errors_px(*decoded);
  std::printf(
      "  %zu points, error p50 %.3f px, p95 %.3f px, worst %.2f px; edges %.3f px, noise %.2f, "
      "stripes %.2f\n",
      errors.size(), median(errors), quantile(errors, 0.95), quantile(errors, 1),
      decoded->edge_residual_px, decoded->noise, decoded->stripe_contrast);
  EXPECT_GT(errors.size(), 5000u);
  EXPECT_LT(median(errors), 0.06);
  EXPECT_LT(quantile(errors, 0.95), 0.2);
  EXPECT_LT(quantile(errors, 1), 2);
  EXPECT_NEAR(decoded->noise, 3, 0.4);
  EXPECT_GT(decoded->lit_share, 0.9);
  EXPECT_EQ(decoded->saturated_share, 0);
}

TEST(GrayCode, StatesTheErrorOfItsPoints) {
  const auto decoded = code().decode(shots().views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  const auto errors = errors_px(*decoded);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < errors.size(); ++i)
    ratios.push_back(errors[i] / decoded->points[i].sigma_px);
  std::printf("  median error %.2f sigma\n", median(ratios));
  EXPECT_GT(median(ratios), 0.6);
  EXPECT_LT(median(ratios), 2.4);
}

TEST(GrayCode, LeavesOutWhatLiesBesideTheBoard) {
  auto seen = board({.board_right_m = 0});
  const auto decoded = code().decode(shoot(code(), seen).views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  EXPECT_NEAR(decoded->lit_share, 0.5, 0.05);
  EXPECT_GT(decoded->points.size(), 2500u);
  for (const auto& point : decoded->points) EXPECT_LT(point.camera_px.x, 364);
  EXPECT_LT(quantile(errors_px(*decoded), 0.95), 0.2);
}

TEST(GrayCode, ReadsTheWhiteSquaresOfAPrintedBoard) {
  auto seen = board({.contrast = 120, .squares_m = 0.03});
  const auto decoded = code().decode(shoot(code(), seen).views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  const auto errors = errors_px(*decoded);
  std::printf("  %zu points, error p50 %.3f px, p95 %.3f px, worst %.2f px\n", errors.size(),
              median(errors), quantile(errors, 0.95), quantile(errors, 1));
  EXPECT_GT(errors.size(), 2000u);
  EXPECT_LT(quantile(errors, 0.95), 0.3);
}

TEST(GrayCode, ReadsAPrintedBoardInATremblingHand) {
  // The print moves by up to 1.6 px from image to image.
  std::vector<RenderedBoard> boards;
  for (const double shift_m : {-0.5e-3, -0.2e-3, 0.2e-3, 0.5e-3})
    boards.push_back(
        board({.contrast = 110, .ambient = 60, .squares_m = 0.010, .print_right_m = shift_m}));
  test::Shots shots{{}, 720, 540};
  std::vector<std::uint8_t> picture(test::kProjectorWidth_px * test::kProjectorHeight_px);
  for (int i = 0; i < code().patterns(); ++i) {
    code().draw(i, picture.data());
    shots.images.push_back(boards[static_cast<std::size_t>(i * i + i / 3) % 4].image_of(picture));
  }
  const auto decoded = code().decode(shots.views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  const auto errors = errors_px(*decoded);
  std::printf("  %zu points, error p50 %.3f px, p95 %.3f px, worst %.2f px\n", errors.size(),
              median(errors), quantile(errors, 0.95), quantile(errors, 1));
  EXPECT_GT(errors.size(), 700u);
  EXPECT_LT(quantile(errors, 0.95), 0.4);
}

TEST(GrayCode, LeavesOutPixelsWithTwoUnsureBits) {
  // Two patterns of columns and their inverses are hidden in the middle of the image.
  auto images = shots().images;
  for (const std::size_t hidden : {10, 11, 14, 15})
    for (int y = 200; y < 300; ++y)
      std::fill_n(images[hidden].begin() + y * 720 + 300, 100, std::uint8_t{60});
  const test::Shots partly{images, 720, 540};
  const auto decoded = code().decode(partly.views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  EXPECT_GT(decoded->points.size(), 5000u);
  for (const auto& [px, projector_px, sigma_px] : decoded->points)
    EXPECT_FALSE(px.x > 300 && px.x < 399 && px.y > 200 && px.y < 299) << px.x << " " << px.y;
}

TEST(GrayCode, ReadsAnOverexposedBoardAndSaysSo) {
  auto seen = board({.contrast = 300, .ambient = 60});
  const auto decoded = code().decode(shoot(code(), seen).views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  EXPECT_GT(decoded->saturated_share, 0.3);
  EXPECT_LT(median(errors_px(*decoded)), 0.2);
}

TEST(GrayCode, SaysThatItIsTooDark) {
  auto seen = board({.contrast = 4});
  const auto decoded = code().decode(shoot(code(), seen).views());
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.error().what, HasSubstr("well enough to be read"));
  EXPECT_EQ(decoded.error().code, Errc::bad_data);
}

TEST(GrayCode, SaysThatTheStripesAreTooFineForTheFocus) {
  auto seen = board({.blur_px = 4});
  const auto decoded = code().decode(shoot(code(), seen).views());
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.error().what, HasSubstr("does not see the finest stripes"));
}

TEST(GrayCode, ReadsWeakLight) {
  auto seen = board({.contrast = 20, .noise = 1});
  const auto decoded = code().decode(shoot(code(), seen).views());
  ASSERT_TRUE(decoded) << decoded.error().what;
  const auto errors = errors_px(*decoded);
  std::printf("  %zu points, error p50 %.3f px, p95 %.3f px\n", errors.size(), median(errors),
              quantile(errors, 0.95));
  EXPECT_GT(errors.size(), 2000u);
  EXPECT_LT(quantile(errors, 0.95), 0.5);
}

TEST(GrayCode, SaysThatTheCameraMovedBetweenThePatterns) {
  // Turned by 1.5 camera pixels in x and in y.
  auto turned = test::coaxial_screen();
  turned.from_camera = turned.from_camera * glm::dmat3(1, 0, 0, 0, 1, 0, 1.5, -1.5, 1);
  RenderedBoard moved(turned, test::tilted_board(test::kPlane_m));
  const auto after = shoot(code(), moved);
  for (int first = 6; first < code().patterns(); first += 10) {
    auto views = after.views();
    std::ranges::copy_n(shots().views().begin(), first, views.begin());
    const auto decoded = code().decode(views);
    ASSERT_FALSE(decoded) << first;
    EXPECT_THAT(decoded.error().what, HasSubstr("move"));
  }
}

TEST(GrayCode, RefusesImagesThatAreNotOfItsPatterns) {
  auto views = shots().views();
  auto swapped = views;
  std::swap(swapped[4], swapped[22]);
  EXPECT_FALSE(code().decode(swapped));
  auto other_size = views;
  other_size[3].height_px = 100;
  EXPECT_THAT(code().decode(other_size).error().what, HasSubstr("differ in size"));
  views.pop_back();
  EXPECT_THAT(code().decode(views).error().what,
              HasSubstr("37 images were given, but there are 38"));
  EXPECT_FALSE(code().decode({}));
}

}  // namespace
}  // namespace handcast::calib
