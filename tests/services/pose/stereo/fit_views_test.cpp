// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/fit_views.hpp"

#include <gtest/gtest.h>

#include <random>

#include "services/pose/stereo/hand_track.hpp"
#include "tests/services/pose/stereo/two_views.hpp"

namespace handcast::pose::stereo {
namespace {

/// Two cameras 40 mm apart, as those of a Leap Motion Controller, 0.28 m before a hand.
Views near_views() {
  View first{two_cameras().camera};
  first.camera = {.width_px = 640,
                  .height_px = 480,
                  .fx_px = 260,
                  .fy_px = 260,
                  .cx_px = 319.5,
                  .cy_px = 239.5};
  View second = first;
  second.view_from_first[3] = glm::dvec4(-0.04, 0, 0, 1);
  return {first, second};
}

TEST(FitViews, ErrorsThatBothViewsShareDoNotSpoilTheDepth) {
  const Views views = near_views();
  const Skeleton skeleton{renderer::load_hand_or_default({}, msg::Side::left).value()};
  HandState truth;
  truth.posture.turn = glm::angleAxis(-1.3, glm::dvec3(1, 0, 0));
  truth.depth_m = 0.28;
  for (int f = 1; f < kFingers; ++f) truth.posture.angle[f] = {0, 0.8, 0.9, 0.5};
  const PosedHand hand = posed(skeleton, truth);

  std::mt19937 random(1);
  std::normal_distribution<double> shared_px(0, 2.5), own_px(0, 0.6);
  double squares_mm2 = 0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    SeenInViews seen{SeenHand{}, SeenHand{}};
    for (int i = 0; i < msg::kLandmarks; ++i) {
      const glm::dvec2 both_px(shared_px(random), shared_px(random));
      for (int v = 0; v < kViews; ++v) {
        seen[v]->px[i] = views[v].project(hand.place_m[msg::kJointOfLandmark[i]]) + both_px +
                         glm::dvec2(own_px(random), own_px(random));
        seen[v]->sigma_px[i] = 5;
      }
    }
    const HandFit fit = fit_views(skeleton, views, seen, HandTrack::of_people(0), truth, 20);
    const PosedHand found = posed(skeleton, fit.state);
    for (const int joint : msg::kJointOfLandmark) {
      const double off_mm = 1e3 * (found.place_m[joint].z - hand.place_m[joint].z);
      squares_mm2 += off_mm * off_mm / (kRuns * msg::kLandmarks);
    }
  }
  // 4.0 mm; 5.4 mm if the errors of both views are taken for independent (correlation 0).
  EXPECT_LT(std::sqrt(squares_mm2), 4.7);
}

TEST(FitViews, PicturesAreAlikeInViewsOfOneDirectionAndTurnWithTheCamera) {
  Views views = near_views();
  EXPECT_GT(likeness_of(views, {0, 0, 0.28}).correlation, 0.5);
  EXPECT_GT(likeness_of(views, {0, 0, 2}).correlation, 0.85);
  EXPECT_LT(likeness_of(views_of(two_cameras()).value(), {0, 0, 0.73}).correlation, 0.4);
  // The second camera is turned by a quarter to the right: what is to the right there is down here.
  glm::dmat4 roll(1);
  roll[0] = {0, -1, 0, 0}, roll[1] = {1, 0, 0, 0};
  views[1].view_from_first = roll * views[1].view_from_first;
  const glm::dvec2 down = likeness_of(views, {0, 0, 0.28}).as_first({1, 0});
  EXPECT_NEAR(down.x, 0, 1e-9);
  EXPECT_NEAR(down.y, 1, 1e-9);
}

}  // namespace
}  // namespace handcast::pose::stereo
