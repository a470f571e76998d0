// SPDX-License-Identifier: Apache-2.0
#include "services/camera/seen_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ipc/msg/owned.hpp"

namespace handcast::camera {
namespace {

constexpr int kWidth_px = 4, kHeight_px = 2;

/// What a projector shows from `lit_ns` on.
msg::Owned<msg::Projection> projection(std::uint64_t picture, std::int64_t lit_ns,
                                       std::uint8_t level) {
  msg::Owned<msg::Projection> message(msg::Projection::bytes(kWidth_px, kHeight_px));
  message->test_picture = picture;
  message->lit_ns = lit_ns;
  message->region_width_px = kWidth_px;
  message->region_height_px = kHeight_px;
  std::fill_n(message->pixels(), kWidth_px * kHeight_px, 0xff000000u | level * 0x010101u);
  return message;
}

TEST(SeenLight, IsDarkBeforeTheFirstPictureAndWhileHandsAreShown) {
  SeenLight light(0);
  EXPECT_FALSE(light.at(100));
  light.add(*projection(1, 100, 255));
  EXPECT_FALSE(light.at(99));
  light.add(*projection(0, 200, 255));
  EXPECT_FALSE(light.at(200));
}

TEST(SeenLight, ShowsTheNewestPictureThatIsLit) {
  SeenLight light(0);
  light.add(*projection(1, 100, 255));
  light.add(*projection(1, 110, 255));
  light.add(*projection(2, 120, 0));
  EXPECT_EQ(light.at(119)->grey[0], 255);
  EXPECT_EQ(light.at(120)->grey[0], 0);
  EXPECT_EQ(light.at(120)->width_px, kWidth_px);
}

TEST(SeenLight, LevelsAreEncodedAsInSrgb) {
  SeenLight light(0);
  light.add(*projection(1, 100, 128));
  EXPECT_EQ(light.at(100)->grey[0], 55) << "IEC 61966-2-1: level 128 is 21.6 % of the light";
}

TEST(SeenLight, ComesLateByTheSetting) {
  SeenLight light(30);
  light.add(*projection(1, 100, 255));
  EXPECT_FALSE(light.at(129));
  EXPECT_TRUE(light.at(130));
}

}  // namespace
}  // namespace handcast::camera
