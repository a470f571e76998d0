// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/number_text.hpp"

#include <gtest/gtest.h>

namespace handcast {
namespace {

TEST(NumberText, ZeroHasNoSign) {
  for (const double zero : {0.0, -0.0, 0.04, -0.04, -0.0499999}) {
    EXPECT_EQ(number_text(zero, 1), "0.0") << zero;
    EXPECT_EQ(signed_text(zero, 1), "0.0") << zero;
  }
  EXPECT_EQ(number_text(-0.4, 0), "0");
  EXPECT_EQ(signed_text(-0.004, 2), "0.00");
}

TEST(NumberText, EveryOtherNumberHasItsPlaces) {
  EXPECT_EQ(number_text(-0.06, 1), "-0.1");
  EXPECT_EQ(number_text(0.06, 1), "0.1");
  EXPECT_EQ(number_text(12.345, 2), "12.35");
  EXPECT_EQ(signed_text(-0.06, 1), "-0.1");
  EXPECT_EQ(signed_text(0.06, 1), "+0.1");
  EXPECT_EQ(signed_text(-12, 0), "-12");
  EXPECT_EQ(signed_text(12, 0), "+12");
}

/// Halves are rounded in one way, to zero and from it.
TEST(NumberText, NoTextIsMinusZero) {
  for (int i = -3000; i <= 3000; ++i)
    for (const int places : {0, 1, 2}) {
      const auto text = number_text(i * 1e-3, places);
      EXPECT_TRUE(text[0] != '-' || text.find_first_of("123456789") != std::string::npos) << text;
    }
}

}  // namespace
}  // namespace handcast
