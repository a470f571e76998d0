#include "services/simulate/recovery.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "services/simulate/hand_speed.hpp"

namespace handcast::simulate {
namespace {

constexpr FaultTime kFault{1.0, 1.2};

/// A thousand moments a second for two seconds.
std::vector<LightMoment> moments_of(const std::function<double(double)>& error_mm, const std::function<bool(double)>& dark = {}) {
  std::vector<LightMoment> moments;
  for (int i = 0; i < 2000; ++i) {
    const double seconds = 0.001 * i;
    moments.push_back({seconds, error_mm(seconds), dark && dark(seconds)});
  }
  return moments;
}

double bad_until(double seconds, double end_s) { return seconds >= 1.0 && seconds < end_s ? 9 : 2; }

TEST(Recovery, IsTheTimeFromTheEndOfTheFaultUntilTheErrorIsAsItWas) {
  const auto recovery = recovery_of(moments_of([](double t) { return bad_until(t, 1.25); }), kFault);
  ASSERT_TRUE(recovery && recovery->recovery_ms);
  EXPECT_NEAR(*recovery->recovery_ms, 50, 1.5);
  EXPECT_NEAR(recovery->usual_mm, 2, 1e-9);
  EXPECT_NEAR(recovery->worst_mm, 9, 1e-9);
  EXPECT_EQ(recovery->dark_ms, 0);
}

TEST(Recovery, AFaultThatIsNotFeltIsOverAtOnce) {
  const auto recovery = recovery_of(moments_of([](double) { return 2; }), kFault);
  ASSERT_TRUE(recovery && recovery->recovery_ms);
  EXPECT_NEAR(*recovery->recovery_ms, 0, 1.5);
}

TEST(Recovery, AGoodMomentBetweenBadOnesIsNoRecovery) {
  const auto error = [](double t) { return t > 1.22 && t < 1.29 ? 2.0 : bad_until(t, 1.4); };
  EXPECT_NEAR(recovery_of(moments_of(error), kFault)->recovery_ms.value_or(0), 200, 1.5);
}

TEST(Recovery, WhatStaysBadIsNeverGoodAgain) {
  const auto recovery = recovery_of(moments_of([](double t) { return bad_until(t, 9); }), kFault);
  ASSERT_TRUE(recovery);
  EXPECT_FALSE(recovery->recovery_ms);
  EXPECT_TRUE(to_json(kFault, moments_of([](double t) { return bad_until(t, 9); }))["recovery_ms"].is_null());
}

TEST(Recovery, AHandWithoutLightIsNotGoodHoweverSmallTheError) {
  const auto dark = [](double t) { return t > 1.1 && t < 1.3; };
  const auto recovery = recovery_of(moments_of([](double) { return 2; }, dark), kFault);
  ASSERT_TRUE(recovery && recovery->recovery_ms);
  EXPECT_NEAR(*recovery->recovery_ms, 100, 1.5);
  EXPECT_NEAR(recovery->dark_ms, 200, 2.5);
}

TEST(Recovery, AMotionsOwnBadMomentsAreNoLateDamage) {
  // Every tenth moment is three times as bad, before the fault as after it.
  const auto error = [](double t) { return static_cast<int>(t * 1000 + 0.5) % 10 == 0 ? 6.0 : 2.0; };
  EXPECT_NEAR(recovery_of(moments_of(error), kFault)->recovery_ms.value_or(999), 0, 1.5);
}

TEST(Recovery, WithoutMomentsBeforeTheFaultThereIsNothingToReturnTo) {
  EXPECT_FALSE(recovery_of(moments_of([](double) { return 2; }), {0.05, 0.2}));
  EXPECT_FALSE(recovery_of({}, kFault));
  EXPECT_TRUE(to_json(kFault, {}).is_null());
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
  EXPECT_FALSE(fault_time(twin)) << "a time, but nothing that happens then";
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
