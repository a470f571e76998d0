// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/fit_reflector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/calib/solve/tracker/moving_hand.hpp"

namespace handcast::calib {
namespace {

using samples::World;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::array<std::size_t, 5> kTips{4, 8, 12, 16, 20};

TrackedTips tips_of(std::string_view side, const samples::Recording& recording) {
  TrackedTips tips{side, {}};
  for (const auto& sample : recording.samples) {
    TrackerSample of_tips{sample.time_ns, {}};
    for (const auto tip : kTips) of_tips.points_m.push_back(sample.points_m[tip]);
    tips.samples.push_back(std::move(of_tips));
  }
  return tips;
}

/// Sightings of a reflector on this finger between two times.
std::vector<Sighting> reflector_on(const samples::Recording& recording, std::size_t finger,
                                   double from_s = 0, double to_s = 1000) {
  std::vector<Sighting> sightings;
  const auto begin_ns = recording.sightings.front().time_ns;
  for (auto sighting : recording.sightings) {
    const double at_s = ns_to_seconds(sighting.time_ns - begin_ns);
    if (sighting.point != static_cast<int>(kTips[finger]) || at_s < from_s || at_s >= to_s)
      continue;
    sighting.point = kIndexTip;
    sightings.push_back(sighting);
  }
  return sightings;
}

/// Seen more exactly than landmarks are, with a twentieth of other bright spots.
World exact(unsigned seed) {
  return {.seed = seed, .seconds = 25, .sighting_px = 0.3, .outliers = 0.05};
}

TEST(FitReflector, FindsPoseAndOffset) {
  const auto truth = samples::record(exact(1));
  const std::vector hands{tips_of("left", truth)};
  const auto found = fit_reflector(truth.camera, hands, reflector_on(truth, 1));
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 2);
  EXPECT_NEAR(static_cast<double>(found->clock_offset_ns) * 1e-6, 5, 1);
  EXPECT_NE(found->quality, Quality::poor);
  EXPECT_THAT(found->findings, Not(Contains(HasSubstr("wrong hand"))));
}

TEST(FitReflector, OnAnotherFingerItIsNamedAndPoor) {
  const auto truth = samples::record(exact(2));
  const std::vector hands{tips_of("left", truth)};
  const auto found = fit_reflector(truth.camera, hands, reflector_on(truth, 3));
  if (found) {
    EXPECT_EQ(found->quality, Quality::poor);
    EXPECT_THAT(found->findings.front(), HasSubstr("The reflector seems to be on the ring finger"));
  } else {
    EXPECT_THAT(found.error().what, HasSubstr("on the ring finger"));
  }
}

TEST(FitReflector, OfTwoHandsTheRightOneIsTaken) {
  const auto truth = samples::record(exact(3));
  const auto other = samples::record(exact(33));  // moves otherwise at the same time
  const std::vector hands{tips_of("left", other), tips_of("right", truth)};
  const auto found = fit_reflector(truth.camera, hands, reflector_on(truth, 1));
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 2);
}

TEST(FitReflector, OnTheWrongHandForAWhileItIsNamed) {
  const auto truth = samples::record(exact(4));
  auto other = truth;  // 12 cm beside the first hand
  const auto aside = glm::dmat3(glm::inverse(truth.camera_from_tracker)) * glm::dvec3(0.12, 0, 0);
  for (auto& sample : other.samples)
    for (auto& point : sample.points_m) point += aside;
  auto sightings = reflector_on(truth, 1, 0, 18);
  for (auto sighting : reflector_on(truth, 1, 18)) {
    const auto at_ns = sighting.time_ns + 5'000'000;
    const auto sample = std::ranges::lower_bound(other.samples, at_ns, {}, &TrackerSample::time_ns);
    if (sample == other.samples.end()) continue;
    const glm::dvec3 at(truth.camera_from_tracker * glm::dvec4(sample->points_m[kTips[1]], 1));
    sighting.undistorted_px = truth.camera.project(at);
    sightings.push_back(sighting);
  }
  const std::vector hands{tips_of("left", truth), tips_of("right", other)};
  const auto found = fit_reflector(truth.camera, hands, sightings);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_THAT(found->findings, Contains(HasSubstr("on the wrong hand for a while")));
  EXPECT_LT(samples::error_mm(truth, *found, samples::kMiddle_m), 3);
}

TEST(FitReflector, WithoutAHandOrAReflectorItIsAnError) {
  const auto truth = samples::record(exact(5));
  const std::vector<TrackedTips> none{{"left", {}}, {"right", {}}};
  const auto no_hand = fit_reflector(truth.camera, none, reflector_on(truth, 1));
  ASSERT_FALSE(no_hand);
  EXPECT_THAT(no_hand.error().what, HasSubstr("has seen no hand"));
  const std::vector hands{tips_of("left", truth)};
  EXPECT_FALSE(fit_reflector(truth.camera, hands, {}));
}

}  // namespace
}  // namespace handcast::calib
