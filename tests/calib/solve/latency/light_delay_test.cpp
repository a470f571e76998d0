// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/latency/light_delay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace handcast::calib {
namespace {

using testing::HasSubstr;

constexpr double kHold_ms = 170, kPeriod_ms = 16.7, kExposure_ms = 4, kDark = 20, kBright = 80;

std::int64_t ns(double ms) { return static_cast<std::int64_t>(ms * 1e6); }

/// A light that toggles, and a camera that watches it.
struct Scene {
  explicit Scene(double delay_ms, int seed = 1, int toggle_count = 20, double bright = kBright) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> noise(0, 0.3);
    std::uniform_real_distribution<double> some(0, 30);
    double time_ms = 1000;
    for (int i = 0; i < toggle_count; ++i, time_ms += kHold_ms + some(random))
      toggles.push_back({ns(time_ms), i % 2 == 0});
    for (double at_ms = 500; at_ms < time_ms + 300; at_ms += kPeriod_ms) {
      double share = 0;
      for (const auto& toggle : toggles) {
        const double begin_ms = 1e-6 * static_cast<double>(toggle.begin_ns) + delay_ms;
        const double after =
            std::clamp((at_ms + kExposure_ms / 2 - begin_ms) / kExposure_ms, 0.0, 1.0);
        share += toggle.is_bright ? after : -after;
      }
      images.push_back(
          {ns(at_ms), ns(kExposure_ms), kDark + (bright - kDark) * share + noise(random)});
    }
  }
  std::vector<Toggle> toggles;
  std::vector<Brightness> images;
};

TEST(LightDelay, IsFoundToAMillisecondWithACameraOf60Hz) {
  for (const double delay_ms : {-12.0, 0.0, 3.3, 25.0, 60.0}) {
    const Scene scene(delay_ms);
    const auto found = fit_light_delay(scene.toggles, scene.images);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_NEAR(found->delay_ms, delay_ms, 1);
    EXPECT_NEAR(found->contrast, kBright - kDark, 2);
  }
}

TEST(LightDelay, ItsIntervalHoldsTheTruthInNineOfTenRuns) {
  int held = 0, narrow = 0;
  constexpr int kRuns = 100;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Scene scene(7.7, seed);
    const auto found = fit_light_delay(scene.toggles, scene.images);
    ASSERT_TRUE(found) << found.error().what;
    held += found->low_ms <= 7.7 && found->high_ms >= 7.7;
    narrow += found->high_ms - found->low_ms < 6;
  }
  EXPECT_GE(held, 90);
  EXPECT_GE(narrow, 90) << "an interval that says nothing";
}

TEST(LightDelay, IsUnbiasedToATenthOfAMillisecond) {
  constexpr int kRuns = 40;
  double sum_ms = 0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const auto found = fit_light_delay(Scene(7, seed, 60).toggles, Scene(7, seed, 60).images);
    ASSERT_TRUE(found) << found.error().what;
    sum_ms += found->delay_ms;
    EXPECT_NEAR(found->delay_ms, 7, 0.3) << seed;
  }
  EXPECT_NEAR(sum_ms / kRuns, 7, 0.1);
}

/// Changes that all meet the same moment of a camera's period.
TEST(LightDelay, ACameraThatKeepsStepWithTheLightGetsAnIntervalThatHoldsTheTruth) {
  for (const double phase_ms : {1.0, 5.0, 9.0, 13.0}) {
    Scene scene(7.7);
    scene.toggles.clear();
    scene.images.clear();
    for (int i = 0; i < 20; ++i)
      scene.toggles.push_back({ns(1000 + phase_ms + 12 * kPeriod_ms * i), i % 2 == 0});
    for (int i = 0; i < 300; ++i) {
      const double at_ms = 500 + i * kPeriod_ms;
      double share = 0;
      for (const auto& toggle : scene.toggles)
        share += (toggle.is_bright ? 1 : -1) *
                 std::clamp((at_ms + kExposure_ms / 2 -
                             1e-6 * static_cast<double>(toggle.begin_ns) - 7.7) /
                                kExposure_ms,
                            0.0, 1.0);
      scene.images.push_back({ns(at_ms), ns(kExposure_ms), kDark + (kBright - kDark) * share});
    }
    const auto found = fit_light_delay(scene.toggles, scene.images);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_LE(found->low_ms, 7.7) << phase_ms;
    EXPECT_GE(found->high_ms, 7.7) << phase_ms;
  }
}

TEST(LightDelay, TheErrorOfTheCamerasClockIsInTheInterval) {
  Scene scene(7);
  const auto sure = fit_light_delay(scene.toggles, scene.images);
  for (auto& image : scene.images) image.error_ns = ns(2);
  const auto unsure = fit_light_delay(scene.toggles, scene.images);
  ASSERT_TRUE(sure && unsure);
  EXPECT_NEAR(unsure->low_ms, sure->low_ms - 2, 1e-6);
  EXPECT_NEAR(unsure->high_ms, sure->high_ms + 2, 1e-6);
}

TEST(LightDelay, AChangeWhoseFirstFrameWasMissedIsLeftOut) {
  Scene scene(7, 1, 30);
  for (std::size_t i = 3; i < scene.toggles.size(); i += 3) {
    scene.toggles[i].begin_ns += ns(17);
    scene.toggles[i].is_sure = false;
  }
  const auto found = fit_light_delay(scene.toggles, scene.images);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->delay_ms, 7, 0.8);
}

TEST(LightDelay, ACameraBehindAnInfraredFilterIsTold) {
  const Scene scene(5, 1, 20, kDark + 1);
  const auto found = fit_light_delay(scene.toggles, scene.images);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().what, HasSubstr("does not see the projector's light"));
  EXPECT_EQ(found.error().code, Errc::bad_data);
}

TEST(LightDelay, TooFewTogglesOrImagesAreNoCameraBehindAFilter) {
  const Scene few(5, 1, 4), scene(5);
  for (const auto& found : {fit_light_delay({}, {}), fit_light_delay(few.toggles, few.images),
                            fit_light_delay(scene.toggles, std::span(scene.images).first(40))}) {
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, Errc::unavailable) << found.error().what;
  }
}

}  // namespace
}  // namespace handcast::calib
