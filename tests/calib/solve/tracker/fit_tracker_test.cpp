// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/fit_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/calib/solve/tracker/moving_hand.hpp"

namespace handcast::calib {
namespace {

using samples::World;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

Result<TrackerFit> fit(const samples::Recording& r) {
  return fit_tracker(r.camera, r.samples, r.sightings);
}

double seconds_of(const samples::Recording& r, const Sighting& s) {
  return ns_to_seconds(s.time_ns - r.sightings.front().time_ns);
}

/// The light of the fit is where the fit expects it: within three standard deviations.
void expect_honest(const samples::Recording& r, const TrackerFit& fit) {
  for (const auto& place : fit.place_errors)
    EXPECT_LT(samples::error_mm(r, fit, place.place_m), 3 * place.whole_mm + 0.1);
}

// Intervals and errors over 200 recordings: bench_calib_tracker.
TEST(FitTracker, FindsPoseAndOffsetOfANoisyRecordingWithOutliers) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const World world{.seed = seed};
    const auto truth = samples::record(world);
    const auto found = fit(truth);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 1.3);
    const auto errors = samples::errors_of(truth, *found, world.offset_s);
    EXPECT_LT(std::hypot(errors[3], errors[4], errors[5]), 0.15);
    EXPECT_LT(std::abs(errors[6]), 1);
    EXPECT_NEAR(found->inlier_share, 0.8, 0.03);
    EXPECT_NE(found->quality, Quality::poor);
    expect_honest(truth, *found);
  }
}

TEST(FitTracker, WithoutNoiseTheAnswerIsExact) {
  const World world{.seconds = 8, .sighting_px = 0, .tracker_mm = 0, .bias_mm = 0, .outliers = 0};
  const auto truth = samples::record(world);
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 0.05);
  EXPECT_NEAR(static_cast<double>(found->clock_offset_ns) * 1e-6, 5, 0.05);
  EXPECT_GT(found->inlier_share, 0.95);
}

TEST(FitTracker, TheOffsetIsTheTrackersClockMinusTheCameras) {
  for (const double offset_s : {-0.09, 0.07}) {
    const auto truth = samples::record(
        {.seconds = 8, .offset_s = offset_s, .reach_m = {0.12, 0.12, 0.11}, .turn_rad = 1.2});
    const auto found = fit(truth);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_NEAR(static_cast<double>(found->clock_offset_ns) * 1e-6, 1000 * offset_s, 1.5);
  }
}

TEST(FitTracker, AReflectorOnOneFingerTipSuffices) {
  const World world{.seconds = 20, .only_index_tip = true};
  const auto truth = samples::record(world);
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 2.5);
  EXPECT_NEAR(static_cast<double>(found->clock_offset_ns) * 1e-6, 5, 2);
  expect_honest(truth, *found);
}

TEST(FitTracker, TheOrderOfTheInputDoesNotMatter) {
  auto truth = samples::record({.seconds = 6});
  const auto in_order = fit(truth);
  std::mt19937 random(3);
  std::ranges::shuffle(truth.samples, random);
  std::ranges::reverse(truth.sightings);
  const auto shuffled = fit(truth);
  ASSERT_TRUE(in_order && shuffled);
  EXPECT_LT(samples::error_mm(truth, *shuffled, samples::kMiddle_m), 2);
  EXPECT_NEAR(static_cast<double>(in_order->clock_offset_ns - shuffled->clock_offset_ns), 0, 1e5);
}

TEST(FitTracker, OnlyTheRatiosOfTheSigmasMatter) {
  auto truth = samples::record({.seconds = 6});
  const auto found = fit(truth);
  for (auto& s : truth.sightings) s.sigma_px = 0.05;
  const auto scaled = fit(truth);
  ASSERT_TRUE(found && scaled);
  EXPECT_EQ(found->clock_offset_ns, scaled->clock_offset_ns);
  EXPECT_EQ(found->inlier_share, scaled->inlier_share);
}

TEST(FitTracker, SightingsWithALargeSigmaCountLess) {
  auto truth = samples::record({.seconds = 8, .bias_mm = 0, .outliers = 0});
  for (std::size_t i = 0; i < truth.sightings.size(); i += 3) {
    truth.sightings[i].undistorted_px += glm::dvec2(8, 0);
    truth.sightings[i].sigma_px = 20;
  }
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 0.3);
}

TEST(FitTracker, LandmarksThatAreNotQuiteTheJointsAreNoFaultOfTheLens) {
  auto truth = samples::record({.outliers = 0.05});
  // Each landmark is another point of the finger than the joint, 2.5 mm away on average.
  for (auto& sample : truth.samples)
    for (std::size_t i = 0; i < sample.points_m.size(); ++i) {
      const auto angle = 2.4 * static_cast<double>(i);
      sample.points_m[i] += 0.0035 * glm::dvec3(std::cos(angle), std::sin(angle), 0);
    }
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_GT(found->held_out.median_px, 3.2) << "else this says nothing";
  EXPECT_THAT(found->findings, Not(Contains(HasSubstr("the lens is not calibrated well"))));
  EXPECT_NE(found->quality, Quality::poor);
}

TEST(FitTracker, HalfOutliersAreTolerated) {
  const auto truth = samples::record({.outliers = 0.5});
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 1.5);
  EXPECT_NEAR(found->inlier_share, 0.5, 0.05);
  EXPECT_THAT(found->findings, Contains(HasSubstr("of the sightings fit; likely reasons")));
  EXPECT_EQ(found->quality, Quality::usable);
}

TEST(FitTracker, GarbageInTheFirstSecondIsLeftOutAndNamed) {
  auto truth = samples::record({.seconds = 10});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 500);
  for (auto& s : truth.sightings)
    if (seconds_of(truth, s) < 1) s.undistorted_px = {any(random), any(random)};
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_THAT(found->findings, Contains(HasSubstr("The first 1.0 s do not fit")));
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 2);
}

TEST(FitTracker, AWrongFingerIsNamedWithItsTime) {
  constexpr int kIndexTip = 8, kMiddleTip = 12;
  auto truth = samples::record({.seconds = 12, .outliers = 0.05});
  // Only the index tip is sighted; from 4 to 7 s, it is the middle finger.
  std::erase_if(truth.sightings, [&](const Sighting& s) {
    const double at_s = seconds_of(truth, s);
    return s.point != (at_s > 4 && at_s < 7 ? kMiddleTip : kIndexTip);
  });
  for (auto& s : truth.sightings) s.point = kIndexTip;
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_THAT(found->findings, Contains(AllOf(HasSubstr("Between 4."), HasSubstr("and 6.9 s"),
                                              HasSubstr("of point 8 fit point 12"))));
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 4);
  expect_honest(truth, *found);
}

TEST(FitTracker, AMirroredImageIsNamed) {
  auto truth = samples::record({.seconds = 6});
  for (auto& s : truth.sightings) s.undistorted_px.x = 2 * truth.camera.cx_px - s.undistorted_px.x;
  const auto found = fit(truth);
  if (found) {
    EXPECT_EQ(found->quality, Quality::poor);
    EXPECT_THAT(found->findings.front(), HasSubstr("image is mirrored"));
  } else {
    EXPECT_THAT(found.error().what, HasSubstr("image is mirrored"));
  }
}

TEST(FitTracker, AHandOfTheOtherSideIsNamed) {
  auto truth = samples::record({.seconds = 6});
  for (auto& sample : truth.samples) {
    auto& hand = sample.points_m;
    const auto across = glm::normalize(hand[5] - hand[17]), middle = (hand[9] + hand[13]) / 2.;
    for (auto& point : hand) point -= 2 * glm::dot(point - middle, across) * across;
  }
  const auto found = fit(truth);
  if (found) {
    EXPECT_EQ(found->quality, Quality::poor);
    EXPECT_THAT(found->findings.front(), HasSubstr("for the other one"));
  } else {
    EXPECT_THAT(found.error().what, HasSubstr("for the other one"));
  }
}

TEST(FitTracker, AnOffsetBeyondTheSearchIsPoorAndNamed) {
  const auto truth = samples::record({.seconds = 10, .offset_s = 0.13});
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->quality, Quality::poor);
  EXPECT_THAT(found->findings, Contains(HasSubstr("at the edge of the search")));
}

TEST(FitTracker, ASmallVolumeIsPoorWithAdvice) {
  const auto truth = samples::record({.reach_m = {0.02, 0.02, 0.01},
                                      .turn_rad = 0.02,
                                      .fingers_bend = false,
                                      .only_index_tip = true});
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->quality, Quality::poor);
  EXPECT_THAT(found->findings, Contains(AllOf(HasSubstr("The points cover only"),
                                              HasSubstr("move the hand nearer and farther"))));
}

TEST(FitTracker, ASmallPartOfTheImageIsPoorHoweverWellItFits) {
  const auto truth = samples::record({.reach_m = {0.035, 0.015, 0.035},
                                      .turn_rad = 0,
                                      .fingers_bend = false,
                                      .only_index_tip = true});
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  for (const auto& place : found->camera_place_mm) EXPECT_LT(place.sd, 10);
  EXPECT_THAT(found->findings, Not(Contains(HasSubstr("A second pose"))));
  EXPECT_EQ(found->quality, Quality::poor);
}

TEST(FitTracker, PointsOnAPlaneAreNamed) {
  const auto truth = samples::record(
      {.reach_m = {0.1, 0.1, 0}, .turn_rad = 0, .fingers_bend = false, .only_index_tip = true});
  auto flat = truth;
  const auto found = fit(flat);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NE(found->quality, Quality::good);
  EXPECT_THAT(found->findings, Contains(HasSubstr("The points lie in a plane")));
  expect_honest(truth, *found);
}

// A small plane looks the same from two sides.
TEST(FitTracker, ASecondPoseThatFitsAsWellIsNamed) {
  const auto truth = samples::record({.seconds = 10,
                                      .reach_m = {0.012, 0, 0.012},
                                      .turn_rad = 0,
                                      .fingers_bend = false,
                                      .only_index_tip = true});
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->quality, Quality::poor);
  EXPECT_THAT(found->findings.front(), HasSubstr("A second pose"));
}

void expect_error(const samples::Recording& r, const std::string& words) {
  const auto found = fit(r);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::bad_data);
  EXPECT_THAT(found.error().what, HasSubstr(words));
}

TEST(FitTracker, AHandThatStandsStillIsAnError) {
  expect_error(samples::record({.seconds = 5, .reach_m = {0, 0, 0}, .turn_rad = 0}),
               "hardly moves");
}

TEST(FitTracker, PointsOnALineAreAnError) {
  auto truth = samples::record({.seconds = 5, .only_index_tip = true});
  for (std::size_t i = 0; i < truth.samples.size(); ++i)
    truth.samples[i].points_m = {{0.1 * std::sin(0.02 * static_cast<double>(i)), 0.2, 0.3}};
  expect_error(truth, "on a line");
}

TEST(FitTracker, UnrelatedSightingsAreAnError) {
  auto truth = samples::record({.seconds = 6});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 500);
  for (auto& s : truth.sightings) s.undistorted_px = {any(random), any(random)};
  expect_error(truth, "did not see the same points");
}

TEST(FitTracker, TimesThatDoNotMeetAreAnError) {
  auto truth = samples::record({.seconds = 5});
  for (auto& s : truth.sightings) s.time_ns += 3'600'000'000'000;
  expect_error(truth, "no common time");
}

TEST(FitTracker, ClocksThatStandStillAreAnError) {
  const auto truth = samples::record({.seconds = 5});
  auto still = truth;
  for (auto& sample : still.samples) sample.time_ns = 7;
  expect_error(still, "tracker's clock stands still");
  still = truth;
  for (auto& s : still.sightings) s.time_ns = truth.sightings.front().time_ns;
  expect_error(still, "camera's clock stands still");
}

TEST(FitTracker, TooLittleDataIsAnError) {
  const auto truth = samples::record({.seconds = 5});
  auto little = truth;
  little.sightings.resize(3);
  expect_error(little, "3 usable sightings in common");
  little.sightings.clear();
  expect_error(little, "0 usable sightings in common");
  little = truth;
  little.samples.clear();
  expect_error(little, "no samples");
  expect_error(samples::record({.seconds = 1}), "in common");
}

TEST(FitTracker, DataThatContradictsItselfIsAnError) {
  const auto truth = samples::record({.seconds = 5});
  auto wrong = truth;
  wrong.samples[7].points_m.pop_back();
  expect_error(wrong, "Sample 7 of the tracker has 20 points");
  wrong = truth;
  wrong.sightings[9].point = 21;
  expect_error(wrong, "A sighting is of point 21");
  wrong = truth;
  for (auto& sample : wrong.samples) sample.points_m.clear();
  expect_error(wrong, "have no points");
}

TEST(FitTracker, NumbersThatAreNotFiniteAreLeftOutAndCounted) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  auto truth = samples::record({.seconds = 8});
  truth.sightings[10].undistorted_px.x = kNan;
  truth.sightings[11].sigma_px = 0;
  truth.sightings[12].sigma_px = kNan;
  truth.samples[100].points_m[3].z = kNan;
  truth.samples[101].points_m[4].x = std::numeric_limits<double>::infinity();
  const auto found = fit(truth);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 2);
  EXPECT_THAT(found->findings, Contains(HasSubstr("3 sightings had numbers")));
  EXPECT_THAT(found->findings, Contains(HasSubstr("2 samples of the tracker had numbers")));
  for (auto& sample : truth.samples) sample.points_m[0].x = kNan;
  expect_error(truth, "No sample of the tracker is finite");
}

}  // namespace
}  // namespace handcast::calib
