// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "calib/solve/board/draw_board.hpp"

namespace handcast::calib {
namespace {

using testing::HasSubstr;

std::string complaint(const Board& board) {
  const auto checked = check_board(board);
  return checked ? "" : checked.error().what;
}

TEST(Board, TheDefaultIsValid) { EXPECT_EQ(complaint({}), ""); }

TEST(Board, ACheckerboardThatLooksTheSameUpsideDownIsRefusedWithAnAlternative) {
  EXPECT_THAT(complaint({BoardKind::checkerboard, 9, 7, 20}), HasSubstr("e.g. 10 x 7"));
  EXPECT_THAT(complaint({BoardKind::checkerboard, 10, 8, 20}), HasSubstr("e.g. 11 x 8"));
  EXPECT_EQ(complaint({BoardKind::checkerboard, 10, 7, 20}), "");
  EXPECT_EQ(complaint({BoardKind::charuco, 10, 8, 20}), "") << "its markers show which end is up";
}

TEST(Board, CirclesWhoseRowsCannotBeToldFromTheColumnsAreRefused) {
  EXPECT_THAT(complaint({BoardKind::circles, 7, 7, 20}), HasSubstr("e.g. 8 x 7"));
}

TEST(Board, MoreMarkersThanThereAreIsAnError) {
  EXPECT_THAT(complaint({BoardKind::charuco, 30, 20, 20}), HasSubstr("300 markers"));
}

TEST(Board, SizesOutOfRangeAreErrorsThatNameTheRange) {
  EXPECT_THAT(complaint({BoardKind::charuco, 2, 7, 20}), HasSubstr("between 3 and 60"));
  EXPECT_THAT(complaint({BoardKind::charuco, 10, -7, 20}), HasSubstr("between 3 and 60"));
  EXPECT_THAT(complaint({BoardKind::charuco, 10, 7, 0}), HasSubstr("between 1 mm and 1000 mm"));
  EXPECT_THAT(complaint({BoardKind::charuco, 10, 7, std::numeric_limits<double>::quiet_NaN()}),
              HasSubstr("between 1 mm and 1000 mm"));
}

TEST(Board, PointsAreInnerCornersOrCentresRowByRow) {
  const auto corners = points_of({BoardKind::checkerboard, 10, 7, 20});
  ASSERT_EQ(corners.size(), 54u);
  EXPECT_LT(glm::distance(corners[0], {0.02, 0.02, 0}), 1e-12);
  EXPECT_LT(glm::distance(corners[1], {0.04, 0.02, 0}), 1e-12);
  EXPECT_LT(glm::distance(corners[53], {0.18, 0.12, 0}), 1e-12);
  const auto centres = points_of({BoardKind::circles, 9, 6, 20});
  ASSERT_EQ(centres.size(), 54u);
  EXPECT_LT(glm::distance(centres[0], {0.01, 0.01, 0}), 1e-12);
  EXPECT_LT(glm::distance(centres[53], {0.17, 0.11, 0}), 1e-12);
}

TEST(DrawBoard, TheMarginIsWhiteAndTheFirstSquareBlack) {
  const auto picture = draw_board({BoardKind::checkerboard, 10, 7, 20}, 10);
  ASSERT_EQ(picture.width_px, 110);
  ASSERT_EQ(picture.height_px, 80);
  const auto at = [&](int x, int y) {
    return picture.pixels[static_cast<std::size_t>(y * 110 + x)];
  };
  EXPECT_EQ(at(4, 4), 255);
  EXPECT_EQ(at(5, 5), 0);
  EXPECT_EQ(at(14, 14), 0);
  EXPECT_EQ(at(15, 14), 255);
  EXPECT_EQ(at(104, 74), 255);
  EXPECT_EQ(at(94, 74), 0);
}

TEST(DrawBoard, EdgesThatCutPixelsAreGreySoThatTheAreaIsRight) {
  const auto black = [](const Board& board, int px_per_square) {
    const auto picture = draw_board(board, px_per_square);
    double sum = 0;
    for (const auto pixel : picture.pixels) sum += 1 - pixel / 255.;
    return sum / (px_per_square * px_per_square);  // in squares
  };
  EXPECT_NEAR(black({BoardKind::checkerboard, 10, 7, 20}, 7), 35, 0.05);
  EXPECT_NEAR(black({BoardKind::circles, 9, 6, 20}, 17), 54 * 3.14159 / 16, 0.1);
}

}  // namespace
}  // namespace handcast::calib
