// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/home.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace handcast {
namespace {

using testing::HasSubstr;

class Home : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* home = std::getenv("HOME")) before_ = home;
    ::setenv("HOME", "/home/somebody", 1);
  }
  void TearDown() override {
    before_.empty() ? ::unsetenv("HOME") : ::setenv("HOME", before_.c_str(), 1);
  }
  std::string before_;
};

TEST_F(Home, TakesThePlaceOfATilde) {
  EXPECT_EQ(*expand_home("~"), "/home/somebody");
  EXPECT_EQ(*expand_home("~/a/b.png"), "/home/somebody/a/b.png");
  EXPECT_EQ(*expand_home("~root/a.png"), "/root/a.png");
}

TEST_F(Home, OtherPathsStay) {
  for (const auto* path : {"", "a.png", "./~/a.png", "/a/~b", "builtin:atlas"})
    EXPECT_EQ(*expand_home(path), path);
}

TEST_F(Home, AnUnknownUserIsNamed) {
  const auto expanded = expand_home("~nobody-of-this-name/a.png");
  ASSERT_FALSE(expanded);
  EXPECT_EQ(expanded.error().code, Errc::bad_config);
  EXPECT_THAT(expanded.error().what, HasSubstr("there is no user 'nobody-of-this-name'"));
}

TEST_F(Home, WithoutTheVariableTheUserDatabaseTells) {
  ::unsetenv("HOME");
  const auto expanded = expand_home("~/a.png");
  ASSERT_TRUE(expanded) << expanded.error().what;
  EXPECT_THAT(*expanded, testing::StartsWith("/"));
}

TEST(OddPath, SaysWhatWasMeantForAnotherProgram) {
  EXPECT_THAT(odd_path("$HOME/a.png"), HasSubstr("variables are not replaced"));
  EXPECT_THAT(odd_path("%USERPROFILE%/a.png"), HasSubstr("variables are not replaced"));
  EXPECT_THAT(odd_path("file:///home/a.png"), HasSubstr("write the path alone"));
  EXPECT_THAT(odd_path("C:\\Users\\a.png"), HasSubstr("a path of Windows"));
  EXPECT_EQ(odd_path("/home/a $b.png"), "");
  EXPECT_EQ(odd_path("a.png"), "");
}

}  // namespace
}  // namespace handcast
