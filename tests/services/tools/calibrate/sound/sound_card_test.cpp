// SPDX-License-Identifier: Apache-2.0
// The real library of ALSA, with a sound card that is emulated below it.
#include "services/tools/calibrate/sound/sound_card.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/tools/calibrate/sound/emulated_sound_card.hpp"

namespace handcast::calibrate {
namespace {

using test::EmulatedSoundCard;
using testing::HasSubstr;

/// A light that changes every 0.2 s, from 0.3 s after `begin_ns` on.
struct Light {
  std::int64_t begin_ns = now_ns() + 300'000'000;
  static constexpr std::int64_t kHold_ns = 200'000'000;

  double at(std::int64_t time_ns) const {
    return time_ns >= begin_ns && (time_ns - begin_ns) / kHold_ns % 2 == 0 ? 0.25 : 0.05;
  }
  /// As a projector reports it that says so much too early.
  std::vector<calib::Toggle> reported(int count, std::int64_t early_ns) const {
    std::vector<calib::Toggle> toggles;
    toggles.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
      toggles.push_back({begin_ns + i * kHold_ns - early_ns, i % 2 == 0});
    return toggles;
  }
};

Result<calib::LightDelay> delay_of(double drift, std::int64_t early_ns, int toggle_count = 14) {
  const Light light;
  const EmulatedSoundCard card([&](std::int64_t time_ns) { return light.at(time_ns); }, drift);
  auto opened = open_sound_card("photodiode");
  if (!opened) return tl::make_unexpected(opened.error());
  Recorder recorder(std::move(*opened));
  sleep_until_ns(light.begin_ns + (toggle_count + 1) * Light::kHold_ns);
  const auto clip = recorder.finish();
  if (!clip) return tl::make_unexpected(clip.error());
  return calib::fit_sound_delay(light.reported(toggle_count, early_ns), *clip);
}

TEST(SoundCard, TheDelayOfALightIsFoundThroughAlsa) {
  const auto found = delay_of(0, 7'000'000);
  ASSERT_TRUE(found) << found.error().what;
  // Samples arrive late on a busy machine, never early.
  EXPECT_NEAR(found->delay_ms, 7, 0.5);
  EXPECT_NEAR(found->contrast, 20, 2) << "percent of full scale";
}

TEST(SoundCard, ACardWhoseClockRunsFastGivesTheSame) {
  const auto found = delay_of(450e-6, 7'000'000, 28);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->delay_ms, 7, 0.7);
}

TEST(SoundCard, ACardThatIsNotThereIsTold) {
  const auto opened = open_sound_card("no_such_card");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what, HasSubstr("sound card 'no_such_card' cannot be opened"));
}

TEST(SoundCard, ARecordingOfAnInstantIsTold) {
  const EmulatedSoundCard card([](std::int64_t) { return 0.0; });
  auto opened = open_sound_card("photodiode");
  ASSERT_TRUE(opened) << opened.error().what;
  Recorder recorder(std::move(*opened));
  const auto clip = recorder.finish();
  ASSERT_FALSE(clip);
  EXPECT_THAT(clip.error().what, HasSubstr("less than half a second"));
}

}  // namespace
}  // namespace handcast::calibrate
