// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace handcast::renderer {
namespace {

using testing::HasSubstr;

const Monitor kDesk{"eDP-1", "", 1920, 1080, 60, true};
const Monitor kBeamer{"HDMI-1", "EPSON PJ", 1280, 800, 60, false};
const Monitor kOther{"DP-2", "EPSON PJ", 1280, 800, 60, false};

TEST(ChooseMonitor, TheOnlyOneBesidesTheOperatorsOwnNeedsNoName) {
  EXPECT_EQ(choose_monitor(std::vector{kDesk, kBeamer}, ""), 1u);
}

TEST(ChooseMonitor, TheOperatorsOwnIsNeverTakenWithoutAName) {
  const auto none = choose_monitor(std::vector{kDesk}, "");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::unavailable);
  EXPECT_THAT(none.error().what, HasSubstr("besides the primary one"));
  EXPECT_THAT(none.error().what, HasSubstr("0: 'eDP-1' (1920x1080, 60 Hz, the primary one)"));
  EXPECT_EQ(choose_monitor(std::vector{kDesk}, "eDP-1"), 0u);
  EXPECT_EQ(choose_monitor(std::vector{kDesk}, "0"), 0u);
}

TEST(ChooseMonitor, IsFoundByItsOutputItsModelOrItsIndex) {
  const std::vector monitors{kDesk, kBeamer};
  for (const auto* wanted : {"HDMI-1", "EPSON PJ", "1"})
    EXPECT_EQ(choose_monitor(monitors, wanted), 1u) << wanted;
}

TEST(ChooseMonitor, WhereSeveralFitAPersonMustChoose) {
  const std::vector monitors{kDesk, kBeamer, kOther};
  for (const auto* wanted : {"", "EPSON PJ"}) {
    const auto refused = choose_monitor(monitors, wanted);
    ASSERT_FALSE(refused) << wanted;
    EXPECT_EQ(refused.error().code, Errc::bad_config);
    EXPECT_THAT(refused.error().what, HasSubstr("'DP-2'"));
  }
  EXPECT_EQ(choose_monitor(monitors, "DP-2"), 2u);
}

TEST(ChooseMonitor, AnAbsentOneMayComeLater) {
  for (const auto* wanted : {"DP-2", "2", "-1", "1x"}) {
    const auto refused = choose_monitor(std::vector{kDesk, kBeamer}, wanted);
    ASSERT_FALSE(refused) << wanted;
    EXPECT_EQ(refused.error().code, Errc::unavailable);
  }
  EXPECT_THAT(choose_monitor({}, "").error().what, HasSubstr("no monitor is connected"));
}

}  // namespace
}  // namespace handcast::renderer
