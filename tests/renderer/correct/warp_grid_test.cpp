// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "renderer/correct/deform.hpp"

namespace handcast::renderer {
namespace {

const Rect kScreen{0, 0, 1024, 768};

WarpGrid grid_of(const std::vector<glm::vec2>& p, const std::vector<glm::vec2>& q,
                 double alpha = 0.5) {
  config::Correct settings;
  settings.alpha = alpha;
  WarpGrid grid;
  make_warp_grid(settings, kScreen, MovingLeastSquares(p, q, static_cast<float>(alpha)), grid);
  return grid;
}

WarpGrid unmoved() { return grid_of({}, {}); }

TEST(WarpGrid, SpansTheWholeImageWithTwentyOneNodesEachWay) {
  const WarpGrid grid = unmoved();
  EXPECT_EQ(grid.nodes.size(), 441u);
  EXPECT_EQ(grid.nodes.front(), glm::vec2(0, 0));
  EXPECT_EQ(grid.nodes.back(), glm::vec2(1023, 767));
  EXPECT_EQ(grid.source(20, 0), glm::vec2(1023, 0));
}

TEST(WarpGrid, NodesGoWhereTheFieldTakesThem) {
  const std::vector<glm::vec2> p{{300, 300}, {500, 350}, {420, 500}},
      q{{310, 290}, {520, 360}, {400, 520}};
  const WarpGrid grid = grid_of(p, q);
  const MovingLeastSquares field(p, q, 0.5f);
  for (const auto& [column, row] : {std::pair{0, 0}, {7, 9}, {20, 20}, {13, 4}})
    EXPECT_LT(glm::distance(grid.nodes[row * 21 + column], field(grid.source(column, row))), 1e-3f);
}

TEST(WarpGrid, ThroughTheNodesTheWarpIsExactAndBetweenThemLinear) {
  const std::vector<glm::vec2> p{{300, 300}, {500, 350}, {420, 500}},
      q{{310, 290}, {520, 360}, {400, 520}};
  const WarpGrid grid = grid_of(p, q);
  for (int row = 0; row < 21; ++row)
    for (int column = 0; column < 21; ++column)
      EXPECT_LT(glm::distance(grid(grid.source(column, row)), grid.nodes[row * 21 + column]),
                0.01f);
  const glm::vec2 along_diagonal = (grid.source(3, 3) + grid.source(4, 4)) * 0.5f;
  EXPECT_LT(
      glm::distance(grid(along_diagonal), (grid.nodes[3 * 21 + 3] + grid.nodes[4 * 21 + 4]) * 0.5f),
      0.01f);
}

TEST(WarpGrid, CellsAreSplitAlongTheirFallingDiagonal) {
  WarpGrid grid = unmoved();
  grid.nodes[3 * 21 + 4] += glm::vec2(10, 0);  // the top right corner of cell (3, 3)
  const glm::vec2 cell = grid.source(4, 4) - grid.source(3, 3);
  const glm::vec2 lower_left = grid.source(3, 3) + cell * glm::vec2(0.2f, 0.8f),
                  upper_right = grid.source(3, 3) + cell * glm::vec2(0.8f, 0.2f);
  EXPECT_LT(glm::distance(grid(lower_left), lower_left), 0.01f);
  EXPECT_NEAR(grid(upper_right).x - upper_right.x, 6, 0.05);
}

TEST(WarpGrid, OutsideItsAreaTheNearestCellGoesOn) {
  const WarpGrid grid = unmoved();
  EXPECT_LT(glm::distance(grid({-50, 900}), {-50, 900}), 0.05f);
}

}  // namespace
}  // namespace handcast::renderer
