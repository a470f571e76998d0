// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/missing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/aruco/charuco.hpp>

#include "calib/solve/board/board_finder.hpp"
#include "tests/calib/solve/board/photograph.hpp"

namespace handcast::calib {
namespace {

using testing::AllOf, testing::HasSubstr;

constexpr Board kCharucoBoard{BoardKind::charuco, 11, 8, 20};
constexpr Board kSquares{BoardKind::checkerboard, 10, 7, 20};
constexpr Board kDiscs{BoardKind::circles, 9, 6, 20};

/// The reference rig's. For boards without markers, of which dozens are searched, it has half as
/// many pixels each way.
CameraModel camera_for(const Board& board) {
  auto camera = reference_rig().camera;
  if (board.kind == BoardKind::charuco) return camera;
  for (double* each : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px}) *each /= 2;
  camera.width_px /= 2;
  camera.height_px /= 2;
  return camera;
}

GreyPicture picture_of(const Board& board) {
  return photograph(board, {.camera = camera_for(board),
                            .camera_from_board = held(board, {0.01, -0.01, 0.55}, {0.2, -0.1})});
}

GreyPicture in_a_mirror(GreyPicture picture) {
  for (int y = 0; y < picture.height_px; ++y)
    std::reverse(picture.pixels.begin() + y * picture.width_px,
                 picture.pixels.begin() + (y + 1) * picture.width_px);
  return picture;
}

std::string why(Board wanted, const GreyPicture& picture) {
  EXPECT_FALSE(BoardFinder(wanted).find(picture.view())) << "the board is there";
  return why_missing(wanted, picture.view());
}

TEST(AMissingBoard, WithItsColumnsAndRowsExchangedIsNamed) {
  EXPECT_THAT(why({BoardKind::charuco, 8, 11, 20}, picture_of(kCharucoBoard)),
              AllOf(HasSubstr("exchanged"), HasSubstr("--board charuco:11x8:20")));
}

TEST(AMissingBoard, NamedByItsInnerCornersIsNamedByItsSquares) {
  EXPECT_THAT(why({BoardKind::checkerboard, 9, 6, 20}, picture_of(kSquares)),
              AllOf(HasSubstr("inner corners"), HasSubstr("--board checkerboard:10x7:20")));
}

TEST(AMissingBoard, OfAnotherKindOrSizeIsNamed) {
  EXPECT_THAT(why(kSquares, picture_of(kCharucoBoard)), HasSubstr("--board charuco:11x8:20"));
  EXPECT_THAT(why(kDiscs, picture_of(kSquares)), HasSubstr("--board checkerboard:10x7:20"));
  EXPECT_THAT(why(kSquares, picture_of(kDiscs)), HasSubstr("--board circles:9x6:20"));
  EXPECT_THAT(why({BoardKind::circles, 9, 7, 20}, picture_of(kDiscs)),
              HasSubstr("--board circles:9x6:20"));
}

TEST(AMissingBoard, InAMirrorIsSaidToBeMirrored) {
  EXPECT_THAT(why(kCharucoBoard, in_a_mirror(picture_of(kCharucoBoard))), HasSubstr("mirrored"));
  EXPECT_THAT(why(kSquares, in_a_mirror(picture_of(kCharucoBoard))),
              AllOf(HasSubstr("mirrored"), HasSubstr("--board charuco:11x8:20")));
}

TEST(AMissingBoard, WithMarkersOfAnotherDictionaryIsNamed) {
  const auto layout = cv::aruco::CharucoBoard::create(
      8, 6, 1, 0.75F, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250));
  cv::Mat1b drawn;
  layout->draw({320, 240}, drawn, 10);
  GreyPicture picture{drawn.cols, drawn.rows, {drawn.begin(), drawn.end()}};
  EXPECT_THAT(why(kCharucoBoard, picture), HasSubstr("markers of DICT_6X6"));
}

TEST(AMissingBoard, OfADarkOrEmptyImageIsNotGuessed) {
  const GreyPicture dark{360, 270, std::vector<std::uint8_t>(360 * 270, 9)},
      empty{360, 270, std::vector<std::uint8_t>(360 * 270, 120)};
  EXPECT_THAT(why(kCharucoBoard, dark), HasSubstr("grey value 9 of 255"));
  EXPECT_THAT(why(kCharucoBoard, empty), HasSubstr("no board of 11 x 8 squares is seen"));
}

}  // namespace
}  // namespace handcast::calib
