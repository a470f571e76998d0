// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/coverage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/calib/solve/lens/synthetic_views.hpp"

namespace handcast::calib {
namespace {

using testing::HasSubstr;

constexpr Board kCoveredBoard{BoardKind::charuco, 10, 7, 20};

BoardView seen(glm::dvec3 middle_m, glm::dvec2 tilt_rad = {0, 0}, double turn_rad = 0) {
  std::mt19937 random(1);
  return view_of(kCoveredBoard, CameraModel{}, held(kCoveredBoard, middle_m, tilt_rad, turn_rad), 0,
                 random);
}

Coverage covered_by(const BoardView& view) {
  Coverage coverage(720, 540);
  coverage.add(view);
  return coverage;
}

TEST(Coverage, NothingIsCoveredAtFirst) {
  const Coverage coverage(720, 540);
  EXPECT_EQ(coverage.share(), 0);
  EXPECT_EQ(coverage.area(), 0);
  EXPECT_NE(coverage.advice(), "");
}

TEST(Coverage, CountsTheCellsInWhichCornersWere) {
  const BoardView view{{0, 1, 2}, {{0, 0}, {5, 5}, {719, 539}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const auto coverage = covered_by(view);
  EXPECT_EQ(coverage.views_in(0, 0), 1) << "views count, not corners";
  EXPECT_EQ(coverage.views_in(5, 4), 1);
  EXPECT_EQ(coverage.views_in(2, 2), 0);
  EXPECT_DOUBLE_EQ(coverage.area(), 2. / 30);
}

TEST(Coverage, CornersOutsideTheImageOrThatAreNoNumbersDoNotCount) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(covered_by({{0, 1, 2}, {{-5, 3}, {nan, nan}, {720, 5}}, {{}, {}, {}}}).area(), 0);
  EXPECT_EQ(covered_by({}).share(), 0);
}

TEST(Coverage, KnowsOnWhichSideTheBoardIsAway) {
  const glm::dvec3 middle_m(0, 0, 0.5);
  EXPECT_EQ(covered_by(seen(middle_m)).views_with(Tilt::flat), 1);
  EXPECT_EQ(covered_by(seen(middle_m, {0, 0.4})).views_with(Tilt::left), 1);
  EXPECT_EQ(covered_by(seen(middle_m, {0, -0.4})).views_with(Tilt::right), 1);
  EXPECT_EQ(covered_by(seen(middle_m, {-0.4, 0})).views_with(Tilt::up), 1);
  EXPECT_EQ(covered_by(seen(middle_m, {0.4, 0})).views_with(Tilt::down), 1);
}

TEST(Coverage, ABoardThatIsTiltedTowardsACornerIsTiltedToBothSides) {
  for (const glm::dvec2 tilt_rad : {glm::dvec2(0.3, 0.45), glm::dvec2(0.45, 0.3)}) {
    const auto coverage = covered_by(seen({0, 0, 0.5}, tilt_rad));
    EXPECT_EQ(coverage.views_with(Tilt::left), 1);
    EXPECT_EQ(coverage.views_with(Tilt::down), 1);
    EXPECT_EQ(coverage.views_with(Tilt::right) + coverage.views_with(Tilt::up), 0);
    EXPECT_EQ(coverage.views_with(Tilt::flat), 0);
  }
  const auto hardly_down = covered_by(seen({0, 0, 0.5}, {0.1, 0.4}));
  EXPECT_EQ(hardly_down.views_with(Tilt::left), 1);
  EXPECT_EQ(hardly_down.views_with(Tilt::down), 0);
}

TEST(Coverage, TheTiltIsThatInTheImageHoweverTheBoardIsTurned) {
  for (const double turn : {0.5, 1.57, 3.1})
    EXPECT_EQ(covered_by(seen({0, 0, 0.5}, {0, 0.4}, turn)).views_with(Tilt::left), 1) << turn;
}

TEST(Coverage, FollowingItsAdviceCoversEverything) {
  Coverage coverage(720, 540);
  std::set<std::string> advices;
  for (double right = -0.14; right < 0.15; right += 0.04)
    for (double down = -0.1; down < 0.11; down += 0.04) coverage.add(seen({right, down, 0.5}));
  EXPECT_EQ(coverage.area(), 1);
  for (int i = 0; i < 4; ++i) {
    const auto advice = coverage.advice();
    if (advice.starts_with("Tilt the board to the left")) coverage.add(seen({0, 0, 0.5}, {0, 0.4}));
    if (advice.starts_with("Tilt the board to the right"))
      coverage.add(seen({0, 0, 0.5}, {0, -0.4}));
    if (advice.starts_with("Tilt the board up")) coverage.add(seen({0, 0, 0.5}, {-0.4, 0}));
    if (advice.starts_with("Tilt the board down")) coverage.add(seen({0, 0, 0.5}, {0.4, 0}));
    advices.insert(advice);
  }
  EXPECT_EQ(advices.size(), 4u);
  EXPECT_EQ(coverage.advice(), "");
  EXPECT_EQ(coverage.share(), 1);
}

TEST(Coverage, NamesTheEmptyPlace) {
  Coverage coverage(720, 540);
  for (const glm::dvec2 tilt : {glm::dvec2(0, 0), {0, 0.4}, {0, -0.4}, {0.4, 0}, {-0.4, 0}})
    coverage.add(seen({0, 0, 0.5}, tilt));
  BoardView everywhere_else;
  for (int y = 0; y < 540; y += 50)
    for (int x = 0; x < 720; x += 50)
      if (x > 240 || y > 210) everywhere_else.image_px.emplace_back(x, y);
  coverage.add(everywhere_else);
  EXPECT_EQ(coverage.advice(), "Hold the board in the top left corner of the image.");
}

}  // namespace
}  // namespace handcast::calib
