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

}  // namespace
}  // namespace handcast
