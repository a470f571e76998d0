// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/board_finder.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <string>

#include "tests/calib/solve/board/photograph.hpp"

namespace handcast::calib {
namespace {

constexpr Board kCheckerboard{BoardKind::checkerboard, 10, 7, 20};
constexpr Board kCircles{BoardKind::circles, 9, 6, 20};
constexpr Board kCharuco{BoardKind::charuco, 10, 7, 20};
constexpr double kDegree = std::numbers::pi / 180;

struct Error {
  double rms_px = 0, worst_px = 0;
};

Error error_of(const BoardView& view, const Shot& shot) {
  Error error;
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const auto true_px = seen_px(shot.camera, shot.camera_from_board, view.board_m[i]);
    const double off_px = glm::distance(view.image_px[i], true_px);
    error.rms_px += off_px * off_px / static_cast<double>(view.ids.size());
    error.worst_px = std::max(error.worst_px, off_px);
  }
  error.rms_px = std::sqrt(error.rms_px);
  return error;
}

Shot shot_of(const Board& board, glm::dvec3 centre_m, glm::dvec2 tilt_rad, double turn_rad = 0) {
  return {.camera = reference_rig().camera,
          .camera_from_board = held(board, centre_m, tilt_rad, turn_rad)};
}

class EveryBoard : public testing::TestWithParam<Board> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryBoard, testing::Values(kCheckerboard, kCircles, kCharuco),
                         [](const auto& test) {
                           return std::string(words_of(
                               test.param.kind)[static_cast<std::size_t>(test.param.kind)]);
                         });

TEST_P(EveryBoard, IsFoundWithinATwentiethOfAPixelFromManySides) {
  const BoardFinder finder(GetParam());
  for (const glm::dvec2 tilt : {glm::dvec2(0, 0), {25, 0}, {-25, 10}, {0, 30}, {10, -30}}) {
    const auto shot = shot_of(GetParam(), {0.01, -0.01, 0.5}, tilt * kDegree, 10 * kDegree);
    const auto view = finder.find(photograph(GetParam(), shot).view());
    ASSERT_TRUE(view) << tilt.x << " " << tilt.y;
    EXPECT_EQ(view->ids.size(), points_of(GetParam()).size());
    const auto error = error_of(*view, shot);
    EXPECT_LT(error.rms_px, 0.05) << tilt.x << " " << tilt.y;
  }
}

TEST_P(EveryBoard, IsFoundInFaintNoisyBlurredInfraredImages) {
  const BoardFinder finder(GetParam());
  for (const double noise : {2., 3., 4.}) {  // of a contrast of 15 grey values
    auto shot = shot_of(GetParam(), {0, 0, 0.45}, glm::dvec2(15, -20) * kDegree);
    shot.black = 15, shot.white = 30, shot.background = 5, shot.noise = noise;
    const auto view = finder.find(photograph(GetParam(), shot).view());
    ASSERT_TRUE(view) << noise;
    const auto error = error_of(*view, shot);
    EXPECT_LT(error.rms_px, 0.7) << noise;
  }
}

TEST_P(EveryBoard, IsFoundInTheDarkBesideALamp) {
  auto shot = shot_of(GetParam(), {0, 0, 0.5}, glm::dvec2(15, -20) * kDegree);
  shot.black = 15, shot.white = 35, shot.background = 25;
  auto picture = photograph(GetParam(), shot);
  cv::Mat1b(540, 720, picture.pixels.data()).colRange(640, 720) = 255;
  const auto view = BoardFinder(GetParam()).find(picture.view());
  ASSERT_TRUE(view);
  const auto error = error_of(*view, shot);
  EXPECT_LT(error.rms_px, 0.3);
}

TEST_P(EveryBoard, IsFoundInAPartOfALargerImage) {
  const auto shot = shot_of(GetParam(), {0, 0, 0.5}, {0, 0});
  const auto picture = photograph(GetParam(), shot);
  const BoardFinder finder(GetParam());
  const auto part = finder.find({picture.pixels.data() + 40 + 30 * 720, 660, 490, 720});
  ASSERT_TRUE(part);
  for (std::size_t i = 0; i < part->ids.size(); ++i) {
    const auto true_px = seen_px(shot.camera, shot.camera_from_board, part->board_m[i]);
    EXPECT_LT(glm::distance(part->image_px[i] + glm::dvec2(40, 30), true_px), 0.2);
  }
}

TEST(BoardFinder, ABoardThatIsUpsideDownIsSeenUpsideDown) {
  for (const auto& board : {kCheckerboard, kCharuco}) {
    const auto shot = shot_of(board, {0, 0, 0.5}, {0, 0}, 175 * kDegree);
    const auto view = BoardFinder(board).find(photograph(board, shot).view());
    ASSERT_TRUE(view);
    EXPECT_LT(error_of(*view, shot).worst_px, 0.2);
  }
}

TEST(BoardFinder, ACharucoBoardMayLeaveTheImage) {
  const auto shot = shot_of(kCharuco, {0.09, -0.05, 0.4}, glm::dvec2(10, 20) * kDegree);
  const auto view = BoardFinder(kCharuco).find(photograph(kCharuco, shot).view());
  ASSERT_TRUE(view);
  EXPECT_GE(view->ids.size(), 12u);
  EXPECT_LT(view->ids.size(), 45u);
  EXPECT_LT(error_of(*view, shot).worst_px, 0.3);
}

TEST(BoardFinder, CornersUnderAHandAreNotGuessed) {
  const auto shot = shot_of(kCharuco, {0, 0, 0.5}, {0, 0}, 20 * kDegree);
  const auto complete = photograph(kCharuco, shot);
  const BoardFinder finder(kCharuco);
  for (int x = 260; x < 460; x += 25) {
    auto picture = complete;
    cv::Mat1b(540, 720, picture.pixels.data()).colRange(x, x + 80) = 60;
    const auto view = finder.find(picture.view());
    ASSERT_TRUE(view);
    EXPECT_GT(view->ids.size(), 20u);
    EXPECT_LT(error_of(*view, shot).worst_px, 1.2) << x;  // and not 9
  }
}

TEST(BoardFinder, CornersAlongOneLineAreNoView) {
  const auto shot = shot_of(kCharuco, {0, 0, 0.5}, {0, 0});
  auto picture = photograph(kCharuco, shot);
  const auto second_row_px = seen_px(shot.camera, shot.camera_from_board, {0, 0.036, 0});
  const auto covered = static_cast<std::ptrdiff_t>(second_row_px.y) * 720;
  std::fill(picture.pixels.begin() + covered, picture.pixels.end(), 90);
  EXPECT_FALSE(BoardFinder(kCharuco).find(picture.view()));
}

TEST(BoardFinder, AnotherBoardIsNotTakenForThisOne) {
  const Board other{BoardKind::checkerboard, 8, 5, 20};
  const auto picture = photograph(other, shot_of(other, {0, 0, 0.4}, {0, 0}));
  EXPECT_FALSE(BoardFinder(kCheckerboard).find(picture.view()));
  EXPECT_FALSE(BoardFinder(kCharuco).find(picture.view()));
  EXPECT_FALSE(BoardFinder(kCircles).find(picture.view()));
}

TEST_P(EveryBoard, IsNotFoundInNoiseOrOnAWall) {
  const BoardFinder finder(GetParam());
  std::mt19937 random(3);
  GreyPicture picture{720, 540, std::vector<std::uint8_t>(720 * 540, 128)};
  EXPECT_FALSE(finder.find(picture.view()));
  for (auto& pixel : picture.pixels) pixel = static_cast<std::uint8_t>(random() % 256);
  EXPECT_FALSE(finder.find(picture.view()));
}

TEST_P(EveryBoard, IsNotFoundInAnEmptyOrATinyImage) {
  const std::uint8_t pixel = 0;
  EXPECT_FALSE(BoardFinder(GetParam()).find({}));
  EXPECT_FALSE(BoardFinder(GetParam()).find({&pixel, 1, 1, 1}));
}

}  // namespace
}  // namespace handcast::calib
