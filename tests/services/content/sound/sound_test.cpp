// SPDX-License-Identifier: Apache-2.0
// Against the real library of ALSA.
#include "services/content/sound/sound.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "ipc/base/clock.hpp"
#include "tests/services/content/sound/sound_devices.hpp"

namespace handcast::content {
namespace {

using test::SoundDevices;
using testing::HasSubstr;

constexpr int kLeftBin = 44, kRightBin = 128;

std::vector<float> sine(double bin, double amplitude) {
  std::vector<float> samples(kHeardSamples);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<float>(
        amplitude * std::sin(2 * std::numbers::pi * bin * static_cast<double>(i) / 2048));
  return samples;
}

std::ptrdiff_t loudest(const std::vector<float>& bins) {
  return std::ranges::max_element(bins) - bins.begin();
}

/// What is heard as soon as it is as wanted, or after 20 s.
Heard await(const SoundListener& listener, const std::function<bool(const Heard&)>& wanted) {
  const auto end = Deadline::in(std::chrono::seconds(20));
  for (;;) {
    auto heard = listener.newest();
    if (wanted(heard) || end.passed()) return heard;
    sleep_until_ns(now_ns() + 1'000'000);
  }
}

/// Each channel is a sound from its first sample on.
bool is_full(const Heard& heard) {
  return std::ranges::all_of(heard.channels, [](const auto& samples) {
    return *std::max_element(samples.begin(), samples.begin() + 500) > 0.1f;
  });
}

class SoundTest : public testing::Test {
 protected:
  void SetUp() override { testing::internal::CaptureStderr(); }
  void TearDown() override {
    if (!is_told_) told();
  }
  std::string told() {
    is_told_ = true;
    return testing::internal::GetCapturedStderr();
  }
  SoundDevices devices_;
  Spectrum spectrum_;

 private:
  bool is_told_ = false;
};

TEST_F(SoundTest, ASineIsThePeakOfItsBinWithItsAmplitude) {
  for (const double bin : {1., 44., 128., 1000.}) {
    const auto& bins = spectrum_.amplitudes(sine(bin, 0.5));
    ASSERT_EQ(bins.size(), 1024u);
    EXPECT_EQ(loudest(bins), static_cast<std::ptrdiff_t>(bin));
    EXPECT_NEAR(std::ranges::max(bins), 0.5, 0.01);
    EXPECT_LT(bins[500], 1e-4);
  }
}

TEST_F(SoundTest, AnImageHasARowPerChannelAndKeepsThePeaks) {
  const Heard heard{{sine(44, 0.5), sine(128, 0.25)}};
  const auto bins = spectrum_.image_of(heard, 64);
  ASSERT_EQ(bins.height, 2);
  ASSERT_EQ(bins.levels.size(), 128u);
  EXPECT_NEAR(bins.levels[44 / 16], 0.5, 0.01);
  EXPECT_NEAR(bins.levels[64 + 128 / 16], 0.25, 0.01);
  const auto wide = spectrum_.image_of(heard, 4096);
  EXPECT_NEAR(wide.levels[4 * 44 + 2], 0.5, 0.01);

  const auto wave = waveform_of(heard, 256);
  ASSERT_EQ(wave.levels.size(), 512u);
  for (std::size_t i = 0; i < 256; ++i)
    ASSERT_NEAR(wave.levels[i], 0.5 + 0.5 * heard.channels[0][kHeardSamples - 256 + i], 1e-6);
}

TEST_F(SoundTest, ShadertoysImageIsInDecibels) {
  const auto image = spectrum_.shadertoy_image_of({{sine(44, 0.01), sine(44, 0.01)}});
  ASSERT_EQ(image.width, 512);
  ASSERT_EQ(image.height, 2);
  EXPECT_NEAR(image.levels[44], (-40. + 100) / 70, 0.01);
  EXPECT_EQ(image.levels[300], 0);
  EXPECT_NEAR(image.levels[512], 0.5, 0.01);
}

TEST_F(SoundTest, ADeviceIsHeardOnBothChannels) {
  const SoundListener listener("tone");
  const auto heard = await(listener, is_full);
  ASSERT_EQ(heard.channels.size(), 2u);
  EXPECT_EQ(loudest(spectrum_.amplitudes(heard.channels[0])), kLeftBin);
  EXPECT_NEAR(std::ranges::max(spectrum_.amplitudes(heard.channels[0])), 0.5, 0.02);
  EXPECT_EQ(loudest(spectrum_.amplitudes(heard.channels[1])), kRightBin);
  EXPECT_EQ(told(), "");
}

TEST_F(SoundTest, TheDeviceOfTheNewestListenerIsHeard) {
  const SoundListener first("silence");
  const auto is_silent = [](const Heard& heard) {
    return heard.channels.size() == 2 && std::ranges::max(heard.channels[0]) == 0;
  };
  EXPECT_TRUE(is_silent(await(first, is_silent)));
  const SoundListener second("tone");
  EXPECT_TRUE(is_full(await(first, is_full)));
}

TEST_F(SoundTest, AMissingDeviceIsNamedOnceAndHeardWhenItIsThere) {
  const SoundListener listener("missing");
  // Two tries at least.
  for (const auto end = Deadline::in(std::chrono::milliseconds(1500)); !end.passed();) {
    ASSERT_EQ(std::ranges::max(listener.newest().channels[0]), 0);
    sleep_until_ns(now_ns() + 10'000'000);
  }
  devices_.add("missing", "tone");
  EXPECT_TRUE(is_full(await(listener, is_full)));
  const auto log = told();
  const std::string why = "content hears silence, because sound device 'missing' cannot be opened";
  ASSERT_THAT(log, HasSubstr(why));
  EXPECT_THAT(log, HasSubstr("`arecord -L` lists the names for content.sound"));
  EXPECT_EQ(log.find(why), log.rfind(why));
  EXPECT_THAT(log, HasSubstr("content hears sound device 'missing'"));
}

TEST_F(SoundTest, ADeviceThatHangsIsSilentAndNamed) {
  {
    const SoundListener listener("hung");
    const auto end = Deadline::in(std::chrono::milliseconds(2500));
    while (!end.passed()) {
      ASSERT_EQ(std::ranges::max(listener.newest().channels[0]), 0);
      sleep_until_ns(now_ns() + 10'000'000);
    }
    EXPECT_THAT(told(), HasSubstr("because sound device 'hung' gives no sound"));
  }
  devices_.release();
}

}  // namespace
}  // namespace handcast::content
