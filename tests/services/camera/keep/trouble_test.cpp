// SPDX-License-Identifier: Apache-2.0
#include "services/camera/keep/trouble.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handcast::camera {
namespace {

TEST(Trouble, IsToldUntilItEnds) {
  Trouble trouble;
  EXPECT_FALSE(trouble.why());
  trouble.say({Errc::bad_config, "a wrong setting"});
  ASSERT_TRUE(trouble.why());
  EXPECT_EQ(trouble.why()->what, "a wrong setting");
  trouble.end();
  EXPECT_FALSE(trouble.why());
}

TEST(Trouble, OnlyASettingEndsAService) {
  Trouble trouble;
  for (const auto code : {Errc::timeout, Errc::disconnected, Errc::unavailable, Errc::bad_data}) {
    trouble.say({code, "gone"});
    EXPECT_EQ(trouble.why()->code, Errc::timeout);
  }
  trouble.say({Errc::bad_config, "wrong"});
  EXPECT_EQ(trouble.why()->code, Errc::bad_config);
}

TEST(Trouble, IsLoggedOnce) {
  Trouble trouble;
  testing::internal::CaptureStderr();
  for (int i = 0; i < 3; ++i) trouble.say({Errc::timeout, "it is gone"});
  const auto logged = testing::internal::GetCapturedStderr();
  EXPECT_EQ(logged.find("it is gone"), logged.rfind("it is gone"));
  EXPECT_NE(logged.find("it is gone"), std::string::npos);
}

}  // namespace
}  // namespace handcast::camera
