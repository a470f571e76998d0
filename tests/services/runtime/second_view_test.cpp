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

TEST(SecondViewNames, AreInTheSentencesOfCodeThatDoesNotKnowIt) {
  EXPECT_EQ(in_second_view("camera 'v4l2': no device (camera.v4l2.device, [camera.v4l2])"),
            "camera2 'v4l2': no device (camera2.v4l2.device, [camera2.v4l2])");
  EXPECT_EQ(in_second_view("camera: all slots of camera.frames are held"),
            "camera2: all slots of camera2.frames are held");
  EXPECT_EQ(in_second_view("landmarks.fallback: there is no back end; set landmarks.fallback."),
            "landmarks2.fallback: there is no back end; set landmarks2.fallback.");
}

TEST(SecondViewNames, AreNotInPathsOrInOtherWords) {
  for (const auto* sentence :
       {"/srv/camera.toml: cannot be read", "'camera.rate_hz.png' is not a PNG",
        "a/camera.rate_hz/x", "the camera 'A-2134' is gone", "camera2.rate_hz: 0",
        "my_camera.rate_hz", "cameras: none", "camera.toml: odd", "twin.camera.rate_hz"})
    EXPECT_EQ(in_second_view(sentence), sentence);
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
