// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/hand_light.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace handcast::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kWidth_px = 720, kHeight_px = 540;

/// An upright hand in the middle of the image, wrist down: fingers of 4 points each.
msg::HandLandmarks upright_hand() {
  msg::HandLandmarks hand;
  const auto put = [&](int i, float x, float y) {
    hand.points[static_cast<std::size_t>(i)] = {x, y, 1, 1};
  };
  put(0, 360, 400);
  for (int finger = 0; finger < 5; ++finger)
    for (int joint = 0; joint < 4; ++joint)
      put(1 + 4 * finger + joint, 300 + 30.0f * static_cast<float>(finger),
          330 - 35.0f * static_cast<float>(joint));
  return hand;
}

/// An image of that hand: its palm, its finger tips, its forearm and the background have these grey
/// values.
struct Scene {
  int palm = 90, tips = 60, background = 12, forearm = 80;

  calib::GreyPicture image(double factor = 1) const {
    calib::GreyPicture picture{kWidth_px, kHeight_px,
                               std::vector<std::uint8_t>(kWidth_px * kHeight_px)};
    for (int y = 0; y < kHeight_px; ++y)
      for (int x = 0; x < kWidth_px; ++x) {
        int grey = background;
        if (x > 290 && x < 430 && y > 240 && y < 400) grey = palm;
        if (x > 290 && x < 430 && y > 215 && y <= 240) grey = tips;
        if (x > 310 && x < 410 && y >= 400) grey = forearm;
        picture.pixels[static_cast<std::size_t>(y) * kWidth_px + static_cast<std::size_t>(x)] =
            static_cast<std::uint8_t>(std::clamp(factor * grey, 0.0, 255.0));
      }
    return picture;
  }
};

HandLight seen(const Scene& scene, int images = 20) {
  HandLight light({});
  for (int i = 0; i < images; ++i) light.add(scene.image().view(), upright_hand(), Lighting::dark);
  return light;
}

constexpr CameraSettings kSettings{.exposure_ms = 1.85, .longest_exposure_ms = 8, .threshold = 0};

TEST(HandLight, HandTipsAndBackgroundAreToldApartAndTheForearmIsNone) {
  const auto light = seen({});
  EXPECT_EQ(light.hand().percentile(0.5), 90);
  EXPECT_EQ(light.tips().percentile(0.5), 60);
  EXPECT_EQ(light.background().percentile(0.5), 12);
  EXPECT_EQ(light.background().share_from(70), 0) << "the forearm is in it";
}

TEST(HandLight, AHandLikeThoseOfTheRealCapturesNeedsNoAdvice) {
  EXPECT_THAT(advice_on(seen({.palm = 80, .tips = 62, .background = 13}), kSettings), IsEmpty());
}

TEST(HandLight, DarkTipsAskForALongerExposureThatDoesNotSaturateThePalm) {
  const auto advice = advice_on(seen({.palm = 40, .tips = 20, .background = 4}), kSettings);
  EXPECT_THAT(advice, Contains(HasSubstr("grey value 20")));
  EXPECT_THAT(advice, Contains(HasSubstr("set camera.exposure_ms to 5.6")));
  const auto bright_palm = advice_on(seen({.palm = 230, .tips = 30, .background = 4}), kSettings);
  EXPECT_THAT(bright_palm, Contains(HasSubstr("bring the infrared lamp nearer")));
  auto short_period = kSettings;
  short_period.longest_exposure_ms = 1.9;
  EXPECT_THAT(advice_on(seen({.palm = 40, .tips = 20, .background = 4}), short_period),
              Contains(HasSubstr("1.9 ms is the longest")));
}

TEST(HandLight, ASaturatedHandAsksForAShorterExposure) {
  const auto advice = advice_on(seen({.palm = 255, .tips = 255}), kSettings);
  EXPECT_THAT(advice, Contains(HasSubstr("is saturated: set camera.exposure_ms to 0.93 or less")));
}

TEST(HandLight, ABrightBackgroundIsTold) {
  EXPECT_THAT(advice_on(seen({.background = 45}), kSettings),
              Contains(HasSubstr("the finger tips (60) hardly stand out")));
}

TEST(HandLight, AThresholdThatIsNotBetweenHandAndBackgroundIsTold) {
  auto settings = kSettings;
  settings.threshold = 70;
  EXPECT_THAT(advice_on(seen({}), settings), Contains(HasSubstr("brighter than the finger tips")));
  settings.threshold = 9;
  EXPECT_THAT(advice_on(seen({}), settings), Contains(HasSubstr("darker than the background")));
  settings.threshold = threshold_between(seen({}));
  EXPECT_THAT(advice_on(seen({}), settings), IsEmpty());
}

TEST(HandLight, ALampThatFlickersIsTold) {
  HandLight light({});
  for (int i = 0; i < 30; ++i)
    light.add(Scene().image(i % 2 ? 1 : 1.15).view(), upright_hand(), Lighting::dark);
  EXPECT_NEAR(light.flicker(), 0.14, 0.03);
  EXPECT_THAT(advice_on(light, kSettings), Contains(HasSubstr("flickers")));
}

TEST(HandLight, TheProjectorsLightOnTheHandIsToldAndIsNoFlicker) {
  HandLight light({});
  for (int i = 0; i < 60; ++i) {
    const bool is_full = i / 2 % 2 == 1;
    light.add(Scene().image(is_full ? 1.3 : 1).view(), upright_hand(),
              is_full ? Lighting::full : Lighting::dark);
  }
  EXPECT_NEAR(light.leak(), 0.3 * 85, 6);
  EXPECT_EQ(light.flicker(), 0);
  EXPECT_THAT(advice_on(light, kSettings), Contains(HasSubstr("infrared-pass filter")));
}

TEST(HandLight, LandmarksBesideTheImageAreLeftOut) {
  auto hand = upright_hand();
  for (auto& point : hand.points) point.x_px = point.x_px > 360 ? 9000 : -1e30f;
  hand.points[3].x_px = std::numeric_limits<float>::quiet_NaN();
  HandLight light({});
  light.add(Scene().image().view(), hand, Lighting::dark);
  EXPECT_EQ(light.images(), 0u);
  EXPECT_EQ(light.hand().total(), 0u);
}

TEST(HandLight, ThePictureHasTheThreeHistograms) {
  auto picture = histograms_picture(seen({}));
  EXPECT_GT(picture.numbers["hand"][90], 0);
  EXPECT_GT(picture.numbers["tips"][60], 0);
  EXPECT_GT(picture.numbers["background"][12], 0);
  EXPECT_EQ(picture.numbers["background"].size(), 256U);
  EXPECT_EQ(picture.numbers["threshold"].front(), threshold_between(seen({})));
}

}  // namespace
}  // namespace handcast::calibrate
