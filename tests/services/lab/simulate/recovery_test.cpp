// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/recovery.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "services/lab/simulate/hand_speed.hpp"
#include "services/lab/simulate/score.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

constexpr FaultTime kFault{1.0, 1.2};

using Error_mm = std::function<double(double seconds)>;
using IsDark = std::function<bool(double seconds)>;

/// Detections before a moment: one every 16 moments, i.e. every 16 ms.
int detections_until(int moment) { return (moment + 8) / 16; }

/// Two seconds of light, at a thousand moments per second.
std::vector<LightMoment> moments_of(const Error_mm& error_mm, const IsDark& dark = {}) {
  std::vector<LightMoment> moments;
  for (int i = 0; i < 2000; ++i) {
    const double seconds = 0.001 * i;
    moments.push_back({seconds, error_mm(seconds), dark && dark(seconds), detections_until(i)});
  }
  return moments;
}

double bad_until(double seconds, double end_s) { return seconds >= 1.0 && seconds < end_s ? 9 : 2; }

std::vector<LightMoment> clean() {
  return moments_of([](double) { return 2; });
}

TEST(Recovery, IsTheTimeFromTheEndOfTheFaultUntilTheErrorIsThatOfTheRunWithoutIt) {
  const auto recovery =
      recovery_of(moments_of([](double t) { return bad_until(t, 1.25); }), clean(), kFault);
  ASSERT_TRUE(recovery && recovery->recovery_ms);
  EXPECT_NEAR(*recovery->recovery_ms, 50, 1.5);
  EXPECT_NEAR(recovery->usual_mm, 2, 1e-9);
  EXPECT_NEAR(recovery->worst_mm, 9, 1e-9);
  EXPECT_EQ(recovery->dark_ms, 0);
}

TEST(Recovery, CountsTheDetectionsItTook) {
  const auto recovery =
      recovery_of(moments_of([](double t) { return bad_until(t, 1.25); }), clean(), kFault);
  ASSERT_TRUE(recovery && recovery->recovery_detections);
  EXPECT_EQ(*recovery->recovery_detections, detections_until(1250) - detections_until(1199));
}

TEST(Recovery, AFaultThatIsNotFeltIsOverAtOnce) {
  const auto recovery = recovery_of(clean(), clean(), kFault);
  ASSERT_TRUE(recovery && recovery->recovery_ms && recovery->recovery_detections);
  EXPECT_NEAR(*recovery->recovery_ms, 0, 1.5);
  EXPECT_EQ(*recovery->recovery_detections, 0);
}

TEST(Recovery, AGoodMomentBetweenBadOnesIsNoRecovery) {
  const auto error = [](double t) { return t > 1.22 && t < 1.29 ? 2.0 : bad_until(t, 1.4); };
  EXPECT_NEAR(recovery_of(moments_of(error), clean(), kFault)->recovery_ms.value_or(0), 200, 1.5);
}

TEST(Recovery, OfARigIsJudgedBesideTheSameRigWithoutTheFault) {
  const auto fault =
      run_rig("twin", "builtin:wave", 1.2,
              {"twin.speed=3", "twin.tracker.lost_at_s=1.0", "twin.tracker.lost_s=0.2",
               "twin.detector.lost_at_s=1.0", "twin.detector.lost_s=0.2"})["fault"];
  EXPECT_GT(fault["worst_mm"].get<double>(), 2 * fault["usual_mm"].get<double>());
  EXPECT_GT(fault["recovery_ms"].get<double>(), 5);
  EXPECT_GE(fault["recovery_detections"].get<int>(), 1);
}

TEST(Recovery, OfFaultsThatOverlapIsCountedFromTheFirstBeginToTheLastEnd) {
  config::Twin twin;
  twin.tracker.decaying = {1.0, 0.6};
  twin.detector.merged = {1.2, 0.9};
  twin.tracker.merged = {1.1, 0.2};
  const auto time = fault_time(twin);
  ASSERT_TRUE(time);
  EXPECT_DOUBLE_EQ(time->begins_s, 1.0);
  EXPECT_DOUBLE_EQ(time->ends_s, 2.1);
  const auto clean = without_faults(twin);
  EXPECT_EQ(clean.tracker.decaying.lasting_s, 0);
  EXPECT_EQ(clean.tracker.merged.lasting_s, 0);
  EXPECT_EQ(clean.detector.merged.lasting_s, 0);
}

TEST(Recovery, AnObjectInTheHandForAWhileIsAFault) {
  config::Twin twin;
  twin.image.object = true;
  EXPECT_FALSE(fault_time(twin)) << "it is held for the whole run";
  twin.image.fault = {1, 0.5};
  ASSERT_TRUE(fault_time(twin));
  EXPECT_DOUBLE_EQ(fault_time(twin)->ends_s, 1.5);
}

TEST(Recovery, WhatStaysBadIsNeverGoodAgain) {
  const auto bad = moments_of([](double t) { return bad_until(t, 9); });
  const auto recovery = recovery_of(bad, clean(), kFault);
  ASSERT_TRUE(recovery);
  EXPECT_FALSE(recovery->recovery_ms);
  EXPECT_FALSE(recovery->recovery_detections);
  EXPECT_TRUE(to_json(kFault, bad, clean())["recovery_ms"].is_null());
}

TEST(Recovery, AHandWithoutLightIsNotGoodHoweverSmallTheError) {
  const auto dark = [](double t) { return t > 1.1 && t < 1.3; };
  const auto recovery = recovery_of(moments_of([](double) { return 2; }, dark), clean(), kFault);
  ASSERT_TRUE(recovery && recovery->recovery_ms);
  EXPECT_NEAR(*recovery->recovery_ms, 100, 1.5);
  EXPECT_NEAR(recovery->dark_ms, 200, 2.5);
}

TEST(Recovery, WhatTheMotionItselfMakesWorseIsNoLateDamage) {
  // The motion gets harder when the fault ends, and stays so.
  const auto burst = [](double t) { return t > 1.2 ? 6.0 : 2.0; };
  EXPECT_NEAR(recovery_of(moments_of(burst), moments_of(burst), kFault)->recovery_ms.value_or(999),
              0, 1.5);
}

TEST(Recovery, AFaultIsFeltAsLongAsTheRunWithoutItIsBetterThanThat) {
  // The error after the fault is no larger than before it, but larger than without the fault.
  const auto once_as_bad = [](double t) {
    return t < 1.0 ? (t < 0.3 ? 4.0 : 2.0) : (t < 1.25 ? 4.0 : 2.0);
  };
  const auto not_any_more = [](double t) { return t < 0.3 ? 4.0 : 2.0; };
  EXPECT_NEAR(recovery_of(moments_of(once_as_bad), moments_of(not_any_more), kFault)
                  ->recovery_ms.value_or(0),
              50, 1.5);
}

TEST(Recovery, WithoutTheRunWithoutTheFaultThereIsNothingToReturnTo) {
  EXPECT_FALSE(recovery_of(clean(), {}, kFault));
  EXPECT_FALSE(recovery_of({}, {}, kFault));
  EXPECT_TRUE(to_json(kFault, {}, {}).is_null());
}

TEST(Recovery, IsMeasuredAgainstTheSameRunWithoutTheFault) {
  const auto rig = rig_with(
      {"twin.motion=builtin:wave", "twin.detector.lost_at_s=0.4", "twin.detector.lost_s=0.1"});
  Options options;
  options.warm_up_s = 0.3;
  options.seconds = 0.4;
  options.draw_every = 0;
  const auto metrics = score(rig, calib::reference_rig(), options);
  ASSERT_TRUE(metrics) << metrics.error().what;
  const auto clean = moments_without_fault(rig, calib::reference_rig(), options);
  ASSERT_TRUE(clean) << clean.error().what;
  std::vector<double> errors_mm;
  for (const auto& moment : *clean) errors_mm.push_back(moment.error_mm);
  std::ranges::nth_element(errors_mm,
                           errors_mm.begin() + static_cast<std::ptrdiff_t>(errors_mm.size() / 2));
  EXPECT_DOUBLE_EQ((*metrics)["fault"]["usual_mm"].get<double>(), errors_mm[errors_mm.size() / 2]);
  EXPECT_GT((*metrics)["fault"]["worst_mm"].get<double>(), 0);
}

TEST(FaultTime, ATwinWithoutFaultsHasNone) {
  config::Twin twin;
  twin.tracker.lost = twin.tracker.frozen = twin.tracker.swapped =
      twin.tracker.wrong_finger = {1.0, 0.2};
  twin.detector.lost = twin.detector.wrong_finger = {1.0, 0.2};
  twin.image.dark = 0.5;
  twin.image.fault = {2, 0.5};
  EXPECT_TRUE(fault_time(twin));
  EXPECT_FALSE(fault_time(without_faults(twin)));
}

TEST(FaultTime, AnImageThatIsSpoiltAllTheTimeStaysSoWithoutTheOtherFaults) {
  config::Twin twin;
  twin.image.dark = 0.5;
  twin.detector.lost = {1.0, 0.2};
  EXPECT_TRUE(without_faults(twin).image.fault.holds(1.1));
}

TEST(FaultTime, SpansEveryFaultThatIsSet) {
  config::Twin twin;
  EXPECT_FALSE(fault_time(twin));
  twin.tracker.lost = {1.0, 0.2};
  twin.detector.wrong_finger = {0.9, 0.1};
  ASSERT_TRUE(fault_time(twin));
  EXPECT_DOUBLE_EQ(fault_time(twin)->begins_s, 0.9);
  EXPECT_DOUBLE_EQ(fault_time(twin)->ends_s, 1.2);
}

TEST(FaultTime, AnImageThatIsSpoiltAllTheTimeHasNone) {
  config::Twin twin;
  twin.image.dark = 0.5;
  EXPECT_FALSE(fault_time(twin));
  twin.image.fault = {2, 0.5};
  ASSERT_TRUE(fault_time(twin));
  EXPECT_DOUBLE_EQ(fault_time(twin)->ends_s, 2.5);
  twin.image.dark = 1;
  EXPECT_FALSE(fault_time(twin)) << "a time is set, but no fault";
}

TEST(HandSpeed, IsThePathOfTheLandmarksOverTime) {
  HandSpeed speed;
  EXPECT_TRUE(speed.to_json().is_null());
  std::array<glm::dvec3, msg::kLandmarks> landmarks{};
  for (int i = 1; i <= 100; ++i) {
    for (auto& landmark : landmarks) landmark.x += i <= 90 ? 0.001 : 0.002;
    speed.add(msg::Side::left, landmarks, 1'000'000 * i);
  }
  EXPECT_NEAR(speed.to_json()["mean"], (89 * 1.0 + 10 * 2.0) / 99, 1e-6);
  EXPECT_NEAR(speed.to_json()["p95"], 2.0, 0.011);
}

TEST(HandSpeed, IsKnownAtTheSlowestProjectors) {
  HandSpeed speed;
  std::array<glm::dvec3, msg::kLandmarks> landmarks{};
  for (int i = 1; i <= 3; ++i) {
    for (auto& landmark : landmarks) landmark.x += 0.001;
    speed.add(msg::Side::left, landmarks, 16'666'667 * i);
  }
  EXPECT_NEAR(speed.to_json()["mean"], 0.06, 1e-6);
}

TEST(HandSpeed, AHandThatComesBackElsewhereDidNotFlyThere) {
  HandSpeed speed;
  std::array<glm::dvec3, msg::kLandmarks> landmarks{};
  speed.add(msg::Side::left, landmarks, 1'000'000);
  for (auto& landmark : landmarks) landmark.x += 1;
  speed.add(msg::Side::left, landmarks, 500'000'000);
  EXPECT_TRUE(speed.to_json().is_null());
}

}  // namespace
}  // namespace handcast::simulate
