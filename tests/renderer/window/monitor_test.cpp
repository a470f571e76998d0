// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
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

/// A block of EDID with the name in its third descriptor.
std::array<std::uint8_t, 128> edid_with(std::string_view name) {
  std::array<std::uint8_t, 128> edid{0, 255, 255, 255, 255, 255, 255, 0};
  edid[54] = 1;  // the first descriptor is a timing
  edid[54 + 36 + 3] = 0xFC;
  std::copy(name.begin(), name.end(), edid.begin() + 54 + 36 + 5);
  edid[127] = static_cast<std::uint8_t>(256 - std::accumulate(edid.begin(), edid.end(), 0) % 256);
  return edid;
}

TEST(ModelOf, IsTheNameInTheEdid) { EXPECT_EQ(model_of(edid_with("EPSON PJ\n    ")), "EPSON PJ"); }

TEST(ModelOf, MayFillTheDescriptor) {
  EXPECT_EQ(model_of(edid_with("THIRTEEN LONG")), "THIRTEEN LONG");
}

TEST(ModelOf, OfADamagedBlockIsEmpty) {
  auto edid = edid_with("EPSON PJ\n");
  EXPECT_EQ(model_of(std::span(edid).first(100)), "");
  EXPECT_EQ(model_of({}), "");
  edid[60] ^= 1;  // the checksum is wrong
  EXPECT_EQ(model_of(edid), "");
}

TEST(ModelOf, HasNoControlCharacters) { EXPECT_EQ(model_of(edid_with("A\x1b[2JB\n")), "A[2JB"); }

}  // namespace
}  // namespace handcast::renderer
