// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/display.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handcast::renderer::kms {
namespace {

using testing::HasSubstr;

const Display kDesk{"/dev/dri/card0", 1, "eDP-1", "", true, {{1920, 1080, 60}}};
const Display kBeamer{"/dev/dri/card0", 2, "HDMI-A-1", "EPSON PJ", true, {{1280, 800, 60}}};
const Display kTwin{"/dev/dri/card1", 3, "DP-1", "EPSON PJ", true, {{1280, 800, 60}}};
const Display kEmpty{"/dev/dri/card1", 4, "DP-2", "", false, {}};

TEST(ChooseDisplay, TheOnlyOneThatIsConnectedNeedsNoName) {
  EXPECT_EQ(choose_display(std::vector{kEmpty, kBeamer}, ""), 1u);
}

TEST(ChooseDisplay, IsFoundByItsConnectorOrItsModel) {
  const std::vector displays{kDesk, kBeamer, kEmpty};
  EXPECT_EQ(choose_display(displays, "HDMI-A-1"), 1u);
  EXPECT_EQ(choose_display(displays, "EPSON PJ"), 1u);
}

TEST(ChooseDisplay, WhereSeveralFitAPersonMustChoose) {
  const std::vector displays{kDesk, kBeamer, kTwin};
  for (const auto* wanted : {"", "EPSON PJ"}) {
    const auto refused = choose_display(displays, wanted);
    ASSERT_FALSE(refused) << wanted;
    EXPECT_EQ(refused.error().code, Errc::bad_config);
    EXPECT_THAT(refused.error().what, HasSubstr("'HDMI-A-1' (EPSON PJ, 1280x800@60), 'DP-1'"));
  }
}

TEST(ChooseDisplay, AnAbsentOneMayComeLater) {
  for (const auto* wanted : {"HDMI-A-7", "DP-2"}) {
    const auto refused = choose_display(std::vector{kDesk, kEmpty}, wanted);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::unavailable);
    EXPECT_THAT(refused.error().what, HasSubstr("'eDP-1' (1920x1080@60), 'DP-2' (empty)"));
  }
  EXPECT_THAT(choose_display(std::vector{kEmpty}, "").error().what,
              HasSubstr("no display is connected"));
  EXPECT_THAT(choose_display({}, "").error().what, HasSubstr("no connector"));
}

}  // namespace
}  // namespace handcast::renderer::kms
