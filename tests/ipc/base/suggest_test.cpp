// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/suggest.hpp"

#include <gtest/gtest.h>

namespace handcast {
namespace {

TEST(Suggest, FindsTheNearestNameButNotAFarOne) {
  EXPECT_EQ(suggest("rate", {"rate_hz", "age_ms"}), "");
  EXPECT_EQ(suggest("rate_h", {"rate_hz", "age_ms"}), " (did you mean 'rate_hz'?)");
  EXPECT_EQ(suggest("qqqqqqqq", {"rate_hz", "age_ms"}), "");
}

TEST(MeantNumber, SaysWhichNumberToWrite) {
  EXPECT_EQ(meant_number("60,5"), "write 60.5, with a decimal point");
  EXPECT_EQ(meant_number("-0,25"), "write -0.25, with a decimal point");
  EXPECT_EQ(meant_number("1.234,5"), "write 1234.5, with a decimal point");
  EXPECT_EQ(meant_number("50%"), "write 0.5: a share is a number, without %");
  EXPECT_EQ(meant_number("12,5 %"), "write 0.125: a share is a number, without %");
  EXPECT_EQ(meant_number("1'000"), "write 1000");
  EXPECT_EQ(meant_number("1 000"), "write 1000");
  EXPECT_EQ(meant_number("060"), "write 60");
  EXPECT_EQ(meant_number(".5"), "write 0.5");
  EXPECT_EQ(meant_number("5."), "write 5");
}

TEST(MeantNumber, LeavesTheUnitToTheSetting) {
  EXPECT_EQ(meant_number("60 Hz"),
            "write the number alone, without 'Hz': its unit is that of the setting");
  EXPECT_EQ(meant_number("1.5ms"),
            "write the number alone, without 'ms': its unit is that of the setting");
  EXPECT_EQ(meant_number("0,3 µs"),
            "write the number alone, with a decimal point and without 'µs': its unit is that of "
            "the setting");
}

TEST(MeantNumber, IsSilentAboutNumbersAndOtherTexts) {
  for (const auto* text : {"", "60", "-1.5", "1e-3", "0", "0.5", "window", "640x480", "192.168.0.5",
                           "2026-11-27", "1,2,3", "Mono8", ",", "-"})
    EXPECT_EQ(meant_number(text), "") << text;
}

}  // namespace
}  // namespace handcast
