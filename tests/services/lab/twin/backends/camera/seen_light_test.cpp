// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/backends/camera/seen_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ipc/msg/owned.hpp"

namespace handcast::camera {
namespace {

constexpr int kWidth_px = 4, kHeight_px = 2;
constexpr std::int64_t kPeriod_ns = 20, kShort_ns = 2;

/// What a projector shows for a period around `display_ns`.
msg::Owned<msg::Projection> projection(std::uint64_t picture, std::int64_t display_ns,
                                       std::uint8_t level) {
  msg::Owned<msg::Projection> message(msg::Projection::bytes(kWidth_px, kHeight_px));
  message->test_picture = picture;
  message->lit_ns = display_ns;
  message->region_width_px = kWidth_px;
  message->region_height_px = kHeight_px;
  std::fill_n(message->pixels(), kWidth_px * kHeight_px, 0xff000000u | level * 0x010101u);
  return message;
}

SeenLight seen_light(std::int64_t late_ns = 0, double true_gamma = 0,
                     const config::Projector& settings = {}) {
  return {late_ns, kPeriod_ns, true_light(settings, true_gamma)};
}
/// The first pixel of the light, 0 if it is dark.
int level(SeenLight& light, std::int64_t middle_ns, std::int64_t exposure_ns = kShort_ns) {
  const auto seen = light.during(middle_ns, exposure_ns);
  return seen ? seen->grey[0] : 0;
}

TEST(SeenLight, IsDarkBeforeTheFirstPictureAndWhileHandsAreShown) {
  auto light = seen_light();
  EXPECT_FALSE(light.during(100, kShort_ns));
  light.add(*projection(1, 100, 255));
  EXPECT_FALSE(light.during(88, kShort_ns));
  light.add(*projection(0, 200, 255));
  EXPECT_FALSE(light.during(200, kShort_ns));
}

TEST(SeenLight, APictureIsLitHalfAPeriodBeforeTheMiddleOfItsLight) {
  auto light = seen_light();
  light.add(*projection(1, 100, 255));
  light.add(*projection(1, 120, 255));
  light.add(*projection(2, 140, 0));
  EXPECT_EQ(level(light, 89), 0);
  EXPECT_EQ(level(light, 91), 255);
  EXPECT_EQ(level(light, 129), 255);
  EXPECT_EQ(level(light, 131), 0);
}

TEST(SeenLight, AnExposureAcrossAChangeSeesItsShareOfBothPictures) {
  auto light = seen_light();
  light.add(*projection(1, 100, 255));
  EXPECT_NEAR(level(light, 90, 16), 128, 1) << "dark, then lit";
  EXPECT_NEAR(level(light, 86, 16), 64, 1);
  light.add(*projection(2, 120, 0));
  EXPECT_NEAR(level(light, 100, 40), 128, 1) << "dark, lit, dark";
}

TEST(SeenLight, LevelsAreEncodedAsInSrgb) {
  auto light = seen_light();
  light.add(*projection(1, 100, 128));
  EXPECT_EQ(level(light, 100), 55) << "IEC 61966-2-1: level 128 is 21.6 % of the light";
}

TEST(SeenLight, AProjectorWhoseGammaTheRigHasWrongMakesOtherLight) {
  auto light = seen_light(0, 1.8);
  light.add(*projection(1, 100, 128));
  EXPECT_EQ(level(light, 100), 74) << "(128 / 255)^1.8";
  config::Projector known;
  known.gamma = 1.8;
  auto right = seen_light(0, 1.8, known);
  right.add(*projection(1, 100, 128));
  EXPECT_NEAR(level(right, 100), 55, 1) << "the light that the level means";
}

TEST(SeenLight, ComesLateByTheSetting) {
  auto light = seen_light(30);
  light.add(*projection(1, 100, 255));
  EXPECT_EQ(level(light, 119), 0);
  EXPECT_EQ(level(light, 121), 255);
}

}  // namespace
}  // namespace handcast::camera
