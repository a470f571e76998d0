// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/latency/sound_delay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace handcast::calib {
namespace {

using testing::HasSubstr;

std::int64_t sound_ns(double ms) { return static_cast<std::int64_t>(ms * 1e6); }

/// What an input without a constant voltage records of a light that toggles.
struct Recording {
  explicit Recording(double delay_ms, float size = 0.1f, float noise = 0.002f, int seed = 1,
                     double least_ms = 240, double most_ms = 260) {
    constexpr double kRate_hz = 48000, kLowest_hz = 5, kSeconds = 6;
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<float> hiss(0, noise);
    std::uniform_real_distribution<double> some(least_ms, most_ms);
    double at_ms = 1000;
    while (at_ms < 5000) {
      toggles.push_back({sound_ns(at_ms), toggles.size() % 2 == 0});
      at_ms += some(random);
    }
    clip.first_ns = 0;
    clip.period_ns = 1e9 / kRate_hz;
    // A high-pass filter of the first order.
    const double decay = std::exp(-2 * M_PI * kLowest_hz / kRate_hz);
    double before = 0, out = 0;
    std::size_t next = 0;
    double light = 0;
    for (int i = 0; i < static_cast<int>(kRate_hz * kSeconds); ++i) {
      const double now_ms = i * 1e3 / kRate_hz;
      while (next < toggles.size() &&
             now_ms >= 1e-6 * static_cast<double>(toggles[next].begin_ns) + delay_ms)
        light = toggles[next++].is_bright ? 1 : 0;
      out = decay * (out + light - before);
      before = light;
      clip.samples.push_back(size * static_cast<float>(out) + hiss(random));
    }
  }
  std::vector<Toggle> toggles;
  SoundClip clip;
};

TEST(SoundDelay, IsFoundToATenthOfAMillisecond) {
  for (const double delay_ms : {-3.0, 0.0, 7.0, 61.5}) {
    const Recording recording(delay_ms);
    const auto found = fit_sound_delay(recording.toggles, recording.clip);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_NEAR(found->delay_ms, delay_ms, 0.1);
    EXPECT_LE(found->low_ms, delay_ms + 0.05);
    EXPECT_GE(found->high_ms, delay_ms - 0.05);
  }
}

TEST(SoundDelay, AnInputMayBeInverted) {
  const Recording recording(7, -0.1f);
  const auto found = fit_sound_delay(recording.toggles, recording.clip);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->delay_ms, 7, 0.1);
}

TEST(SoundDelay, TheErrorOfTheClockIsInTheInterval) {
  Recording recording(7);
  const auto sure = fit_sound_delay(recording.toggles, recording.clip);
  recording.clip.error_ns = sound_ns(1);
  const auto unsure = fit_sound_delay(recording.toggles, recording.clip);
  ASSERT_TRUE(sure && unsure);
  EXPECT_NEAR(unsure->low_ms, sure->low_ms - 1, 1e-6);
}

TEST(SoundDelay, APhotodiodeInTheDarkIsTold) {
  const Recording recording(7, 0.0002f);
  const auto found = fit_sound_delay(recording.toggles, recording.clip);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().what, HasSubstr("does not see the light"));
}

/// Another lamp that flickers fast: there is a step of either direction near each change of the
/// light, only at no certain time.
TEST(SoundDelay, StepsWithoutAnyRelationToTheLightAreTold) {
  for (int seed = 1; seed <= 20; ++seed) {
    const Recording light(7, 0.1f, 0.002f, seed);
    const Recording lamp(0, 0.1f, 0.002f, seed + 100, 30, 90);
    const auto found = fit_sound_delay(light.toggles, lamp.clip);
    ASSERT_FALSE(found) << "seed " << seed << ": " << found->delay_ms << " ms";
    EXPECT_EQ(found.error().code, Errc::bad_data);
    EXPECT_THAT(found.error().what, HasSubstr("ms apart from each other")) << "seed " << seed;
  }
}

/// As slow as the light itself: half of its changes have no step.
TEST(SoundDelay, ALampAsSlowAsTheLightIsNotTakenForIt) {
  for (int seed = 1; seed <= 20; ++seed) {
    const Recording light(7, 0.1f, 0.002f, seed);
    const Recording lamp(0, 0.1f, 0.002f, seed + 100, 150, 400);
    const auto found = fit_sound_delay(light.toggles, lamp.clip);
    ASSERT_FALSE(found) << "seed " << seed << ": " << found->delay_ms << " ms";
    EXPECT_EQ(found.error().code, Errc::bad_data);
  }
}

/// The middle of errors of 4 ms is known; with errors of 15 ms there is nothing to be known.
TEST(SoundDelay, StepsAtUncertainTimesAreTakenUpToFiveMilliseconds) {
  for (const double scatter_ms : {4.0, 15.0}) {
    Recording recording(20);
    for (std::size_t i = 0; i < recording.toggles.size(); ++i)
      recording.toggles[i].begin_ns += sound_ns(scatter_ms * (static_cast<double>(i / 2 % 3) - 1));
    const auto found = fit_sound_delay(recording.toggles, recording.clip);
    EXPECT_EQ(found.has_value(), scatter_ms < 5);
    if (found)
      EXPECT_LE(found->high_ms - found->low_ms, 2 * scatter_ms + 0.2);
    else
      EXPECT_THAT(found.error().what, HasSubstr("ms apart from each other"));
  }
}

TEST(SoundDelay, AClipThatIsTooShortIsTold) {
  Recording recording(7);
  recording.clip.samples.resize(48000 * 2);
  const auto found = fit_sound_delay(recording.toggles, recording.clip);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().what, HasSubstr("changes of the light were recorded"));
  EXPECT_FALSE(fit_sound_delay(recording.toggles, {}));
}

}  // namespace
}  // namespace handcast::calib
