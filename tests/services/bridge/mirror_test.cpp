// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/mirror.hpp"

#include <gmock/gmock.h>

namespace handcast::bridge {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Mirror, FollowsWhatHasChangedOfLightAndContentAlone) {
  Mirror mirror;
  EXPECT_THAT(mirror.follow("light.brightness = 0.5\ncascade.skin.on = true\n"),
              ElementsAre("light.brightness=0.5"));
  EXPECT_THAT(mirror.follow("light.brightness = 0.5\n"), IsEmpty());
  EXPECT_THAT(mirror.follow("content.left = \"lava = 1\"\nlight.brightness = 0.4\n"),
              ElementsAre("content.left=\"lava = 1\"", "light.brightness=0.4"));
}

TEST(Mirror, AValueOfTheFileThereIsThatOfTheFileHere) {
  Mirror mirror;
  mirror.follow("light.blackout = true\nlight.brightness = 0.5");
  EXPECT_THAT(mirror.follow("light.brightness = 0.5"), ElementsAre("light.blackout"));
  EXPECT_THAT(mirror.follow(""), ElementsAre("light.brightness"));
}

TEST(Mirror, TextThatIsNoSettingIsPassedOver) {
  Mirror mirror;
  EXPECT_THAT(mirror.follow("light.\n\n\n = = =\ncontent.left\x1b"), IsEmpty());
}

}  // namespace
}  // namespace handcast::bridge
