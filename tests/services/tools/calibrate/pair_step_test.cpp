// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pair_step.hpp"

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/calib/solve/pair/pair_world.hpp"

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

constexpr double kDegree = 0.017453292519943295;

/// Two cameras as in config/calibrations/leap.toml.
calib::PairWorld leap() {
  calib::PairWorld world;
  world.first = {640, 480, 150, 150, 319.5, 239.5};
  world.second = world.first;
  world.second_from_first = glm::translate(glm::dmat4(1), {-0.04, 0, 0});
  world.middle_m = 0.3;
  return world;
}

/// The verdict on one view of a still board, by a calibration.
Outcome verdict_on(const std::vector<calib::PairView>& views, const calib::PairWorld& world,
                   const glm::dmat4& calibrated) {
  const auto off =
      calib::pair_off(std::span(views).first(1), world.first,
                      {.device = {}, .camera = world.second, .from_camera = calibrated});
  return off ? judge_pair(*off, world.board.square_mm)
             : Outcome{"no corner was seen by both", false};
}

/// The verdict on a pair that was calibrated as `world` says and whose second camera then moved.
Outcome verdict(const glm::dmat4& moved, unsigned seed, calib::PairWorld world = {}) {
  const auto calibrated = world.second_from_first;
  world.second_from_first = moved * calibrated;
  return verdict_on(calib::show(world, seed), world, calibrated);
}

TEST(PairCheck, APairThatWasMeasuredAndHasNotMovedIsNotAccused) {
  for (const auto& world : {calib::PairWorld{}, leap()})
    for (unsigned seed = 1; seed <= 15; ++seed) {
      const auto fit = calib::fit_pair(calib::show(world, seed), calib::exact(world));
      ASSERT_TRUE(fit) << fit.error().what;
      for (const double farther : {1.0, 1.7, 3.0}) {
        auto now = world;
        now.middle_m *= farther;
        const auto outcome = verdict_on(calib::show(now, seed + 1000), now, fit->second_from_first);
        EXPECT_TRUE(outcome.is_good) << world.middle_m << " " << seed << ": " << outcome.made;
      }
    }
}

TEST(PairCheck, ABoardWithOtherSquaresMayBeTheReason) {
  calib::PairWorld world;
  auto views = calib::show(world, 1);
  for (auto& view : views)
    for (auto* seen : {&view.first, &view.second})
      for (auto& m : seen->board_m) m *= 0.8;
  const auto outcome = verdict_on(views, world, world.second_from_first);
  EXPECT_FALSE(outcome.is_good);
  ASSERT_EQ(outcome.findings.size(), 2U);
  EXPECT_THAT(outcome.findings.back(), HasSubstr("the squares of this board are not 20 mm"));
  const auto off_lines = judge_pair({.off_line_px = 5, .along_m = 0.1, .parallax_px = 30}, 20);
  EXPECT_EQ(off_lines.findings.size(), 1U) << "no size of a board explains that";
}

TEST(PairCheck, ACameraThatWasBumpedIsFoundWhateverItTurnedAbout) {
  for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), {0, 1, 0}})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const auto outcome = verdict(glm::rotate(glm::dmat4(1), 0.5 * kDegree, axis), seed);
      EXPECT_FALSE(outcome.is_good) << axis.x << " " << seed << ": " << outcome.made;
      ASSERT_FALSE(outcome.findings.empty());
      EXPECT_THAT(outcome.findings.front(), HasSubstr("measure the step `pair` again"));
      // Its pixels are eight times as large.
      const auto of_leap = verdict(glm::rotate(glm::dmat4(1), kDegree, axis), seed, leap());
      EXPECT_FALSE(of_leap.is_good) << axis.x << " " << seed << ": " << of_leap.made;
    }
}

TEST(PairCheck, ACameraThatWasShiftedIsFound) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(verdict(glm::translate(glm::dmat4(1), {0.005, 0, 0}), seed).is_good) << seed;
    EXPECT_FALSE(verdict(glm::translate(glm::dmat4(1), {0, 0.003, 0}), seed).is_good) << seed;
  }
}

TEST(PairCheck, TheSentenceSaysHowFarAndInWhichDirection) {
  const auto outcome = judge_pair({0.3, {0.003, -0.004, 0}, -0.0205, -5, 0.7}, 20);
  EXPECT_THAT(outcome.made, HasSubstr("at 0.70 m what both cameras see is off by 5.0 mm across and "
                                      "20.5 mm along the first camera's rays"));
  EXPECT_FALSE(outcome.is_good);
  EXPECT_TRUE(judge_pair({0.3, {0.001, -0.001, 0}, 0.003, 0.7, 0.7}, 20).is_good);
  EXPECT_FALSE(judge_pair({0.3, {0, 0, 0}, -0.02, -1.6, 0.7}, 20).is_good);
  EXPECT_TRUE(judge_pair({0.3, {0, 0, 0}, -0.02, -1.4, 0.7}, 20).is_good)
      << "no more than the images tell";
}

TEST(PairCheck, WhatTheBoardsDistanceIsOffByMovesItInTheSecondImage) {
  const auto world = leap();
  const calib::SecondCamera there{
      .device = {}, .camera = world.second, .from_camera = world.second_from_first};
  const auto middle = glm::translate(glm::dmat4(1), {0.3, 0, 0.3});
  std::mt19937 random(1);
  calib::PairView view;
  view.first = calib::view_of(world.board, world.first, middle, 0, random);
  view.second =
      calib::view_of(world.board, world.second, world.second_from_first * middle, 0, random);
  for (auto& px : view.second.image_px) px.x += 2;
  const auto off = calib::pair_off(std::span(&view, 1), world.first, there);
  ASSERT_TRUE(off);
  EXPECT_LT(off->off_line_px, 0.01);
  EXPECT_LT(glm::length(off->across_m), 1e-4) << "it is far beside the axis";
  EXPECT_NEAR(std::abs(off->parallax_px), 2, 0.3) << "less by the square of the distance";
  EXPECT_GT(off->along_m, 0.02);
}

TEST(PairCheck, WhatTheSecondCameraShouldSeeIsKnown) {
  const calib::PairWorld world;
  const auto view = calib::show(world, 1).front().first;
  const calib::SecondCamera there{
      .device = {}, .camera = world.second, .from_camera = world.second_from_first};
  EXPECT_TRUE(calib::is_whole_in_second(view, world.first, there));
  const auto turned = [&](double angle_rad) {
    auto away = there;
    away.from_camera = glm::rotate(glm::dmat4(1), angle_rad, {0, 1, 0}) * there.from_camera;
    return calib::is_whole_in_second(view, world.first, away);
  };
  EXPECT_FALSE(turned(1)) << "it sees nothing of it";
  EXPECT_FALSE(turned(0.2)) << "a checkerboard of which it sees a part is not found";
}

TEST(PairCheck, WhatALensWouldBendBackIntoTheImageIsNotExpectedThere) {
  const calib::PairWorld world;
  std::mt19937 random(1);
  const auto view = calib::view_of({calib::BoardKind::charuco, 4, 3, 5}, world.first,
                                   glm::translate(glm::dmat4(1), {0, 0, 0.73}), 0, random);
  calib::SecondCamera there{.device = {}, .camera = world.second};
  there.camera.k1 = -0.3;
  there.camera.k2 = 0;
  EXPECT_TRUE(calib::is_whole_in_second(view, world.first, there));
  // At 1.73 focal lengths from the middle, which the lens brings to 0.18.
  there.from_camera = glm::rotate(glm::dmat4(1), 1.05, {0, 1, 0});
  EXPECT_FALSE(calib::is_whole_in_second(view, world.first, there));
}

}  // namespace
}  // namespace handcast::calibrate
