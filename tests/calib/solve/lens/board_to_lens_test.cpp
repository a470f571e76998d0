// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "calib/solve/board/board_finder.hpp"
#include "calib/solve/lens/lens_fit.hpp"
#include "tests/calib/solve/board/photograph.hpp"
#include "tests/calib/solve/lens/synthetic_views.hpp"

namespace handcast::calib {
namespace {

/// The whole way: print, hold it in front of a camera, find it, determine the lens.
TEST(BoardToLens, PicturesOfAPrintedBoardGiveTheLens) {
  const Board board{BoardKind::charuco, 10, 7, 20};
  CameraModel truth;
  truth.k1 = -0.25, truth.k2 = 0.1, truth.cx_px = 350, truth.cy_px = 280;
  const BoardFinder finder(board);
  std::vector<BoardView> views;
  unsigned seed = 1;
  for (const glm::dvec2 place : {glm::dvec2(-1, -1), {1, -1}, {-1, 1}, {1, 1}, {0, 0}})
    for (const glm::dvec2 tilt : {glm::dvec2(0.45, 0.3), {-0.35, -0.45}, {0.3, -0.5}}) {
      const glm::dvec3 middle_m(place * glm::dvec2(0.07, 0.05), 0.38);
      const Shot shot{.camera = truth,
                      .camera_from_board = held(board, middle_m, tilt * (0.8 + 0.02 * seed)),
                      .black = 20,
                      .white = 120,
                      .noise = 3,
                      .seed = seed++};
      if (auto view = finder.find(photograph(board, shot).view())) views.push_back(*view);
    }
  ASSERT_GE(views.size(), 14u);
  const auto fitted = fit_lens(views, truth.width_px, truth.height_px);
  ASSERT_TRUE(fitted) << fitted.error().what;
  EXPECT_NEAR(fitted->camera.fx_px / truth.fx_px, 1, 0.003);
  EXPECT_LT(reprojection_px(fitted->camera, truth), 0.3);
  EXPECT_LT(fitted->rms_px, 0.2);
}

}  // namespace
}  // namespace handcast::calib
