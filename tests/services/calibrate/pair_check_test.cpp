// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/pair_check.hpp"

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/calib/pair/pair_world.hpp"

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

constexpr double kDegree = 0.017453292519943295;

/// The verdict on a pair that was calibrated as `world` says and whose second camera then moved.
/// `count`: views, all of one still board.
Outcome verdict(const glm::dmat4& moved, unsigned seed) {
  calib::PairWorld world;
  const auto calibrated = world.second_from_first;
  world.second_from_first = moved * calibrated;
  const auto views = calib::show(world, seed);
  const auto off =
      calib::pair_off(std::span(views).first(1), world.first,
                      {.device = {}, .camera = world.second, .from_camera = calibrated});
  return off ? judge_pair(*off) : Outcome{"no corner was seen by both", false};
}

TEST(PairCheck, APairThatHasNotMovedIsNotAccused) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const auto outcome = verdict(glm::dmat4(1), seed);
    EXPECT_TRUE(outcome.is_good) << seed << ": " << outcome.made;
  }
}

TEST(PairCheck, ACameraThatWasBumpedIsFoundWhateverItTurnedAbout) {
  for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), {0, 1, 0}})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const auto outcome = verdict(glm::rotate(glm::dmat4(1), 0.5 * kDegree, axis), seed);
      EXPECT_FALSE(outcome.is_good) << axis.x << " " << seed << ": " << outcome.made;
      ASSERT_FALSE(outcome.findings.empty());
      EXPECT_THAT(outcome.findings.front(), HasSubstr("measure the step `pair` again"));
    }
}

TEST(PairCheck, ACameraThatWasShiftedIsFound) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(verdict(glm::translate(glm::dmat4(1), {0.005, 0, 0}), seed).is_good) << seed;
    EXPECT_FALSE(verdict(glm::translate(glm::dmat4(1), {0, 0.003, 0}), seed).is_good) << seed;
  }
}

TEST(PairCheck, TheSentenceSaysHowFarAndInWhichDirection) {
  const auto outcome = judge_pair({0.3, {0.003, -0.004, 0.0205}, 0.7});
  EXPECT_THAT(outcome.made, HasSubstr("at 0.70 m what both cameras see is off by 5.0 mm across and "
                                      "20.5 mm along the first camera's axis"));
  EXPECT_FALSE(outcome.is_good);
  EXPECT_TRUE(judge_pair({0.3, {0.001, -0.001, 0.003}, 0.7}).is_good);
}

TEST(PairCheck, WhatTheSecondCameraShouldSeeIsKnown) {
  const calib::PairWorld world;
  const auto view = calib::show(world, 1).front().first;
  const calib::SecondCamera there{
      .device = {}, .camera = world.second, .from_camera = world.second_from_first};
  EXPECT_GT(calib::share_in_second(view, world.first, there), 0.9);
  auto away = there;
  away.from_camera = glm::rotate(glm::dmat4(1), 1.0, {0, 1, 0}) * there.from_camera;
  EXPECT_EQ(calib::share_in_second(view, world.first, away), 0);
}

}  // namespace
}  // namespace handcast::calibrate
