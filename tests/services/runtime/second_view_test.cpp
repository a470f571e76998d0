// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/second_view.hpp"

#include <gmock/gmock.h>

#include "config/second_view.hpp"

namespace handcast::service {
namespace {

using testing::ElementsAre;

TEST(SecondViewNames, AreThoseOfItsOwnStreamsAndSections) {
  EXPECT_EQ(of_second_view("camera.frames"), "camera2.frames");
  EXPECT_EQ(of_second_view("landmarks.hands"), "landmarks2.hands");
  EXPECT_EQ(of_second_view("camera"), "camera2");
  EXPECT_EQ(of_second_view("pose.hands"), "pose.hands") << "both views read the same poses";
  EXPECT_EQ(of_second_view("cameras.x"), "cameras.x");
}

TEST(SecondViewNames, AreInTheWholeDescription) {
  const auto second = of_second_view({.name = "landmarks",
                                      .summary = "Looks.",
                                      .paced_by = "camera.frames",
                                      .publishes = {"landmarks.hands"},
                                      .subscribes = {"camera.frames", "pose.hands"},
                                      .settings = {"landmarks.hands"},
                                      .backends = {{"a", "A.", {"camera.rate_hz", "twin"}}}});
  EXPECT_EQ(second.name, "landmarks2");
  EXPECT_EQ(second.paced_by, "camera2.frames");
  EXPECT_THAT(second.publishes, ElementsAre("landmarks2.hands"));
  EXPECT_THAT(second.subscribes, ElementsAre("camera2.frames", "pose.hands"));
  EXPECT_THAT(second.settings, ElementsAre("landmarks2.hands"));
  EXPECT_THAT(second.backends[0].settings, ElementsAre("camera2.rate_hz", "twin"));
  EXPECT_TRUE(second.is_second_view);
}

TEST(SecondViewRig, HasTheSecondSectionsInThePlacesOfTheFirst) {
  config::Rig rig;
  rig.camera.rate_hz = 500;
  rig.camera2.rate_hz = 100;
  rig.landmarks2.hands = 1;
  const auto second = config::seen_by_second(rig);
  EXPECT_EQ(second.camera.rate_hz, 100);
  EXPECT_EQ(second.landmarks.hands, 1);
}

}  // namespace
}  // namespace handcast::service
