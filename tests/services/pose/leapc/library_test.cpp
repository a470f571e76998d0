// SPDX-License-Identifier: Apache-2.0
// Ultraleap's library: found, absent, old, incomplete, and something else.
#include "services/pose/leapc/library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scratch.hpp"
#include "tests/services/pose/leapc/leapc_rig.hpp"

namespace handcast::pose::leapc {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string why_not(const std::string& path) {
  const auto library = open_library(path);
  if (library) return "it was opened";
  EXPECT_EQ(library.error().code, Errc::bad_config);
  return library.error().what;
}

TEST(LeapcLibrary, IsOpenedAndSaysItsVersion) {
  const auto library = open_library(FAKE_LEAPC);
  ASSERT_TRUE(library) << library.error().what;
  EXPECT_EQ(library->version, "5.4.0");
}

TEST(LeapcLibrary, AnAbsentOneIsNamedWithItsPath) {
  EXPECT_THAT(why_not("/nowhere/libLeapC.so"), HasSubstr("/nowhere/libLeapC.so: there is no such"));
}

TEST(LeapcLibrary, WithoutAPathItSaysWhatToInstallInOneShortSentence) {
  const auto library = open_library("");
  if (library) GTEST_SKIP() << "Ultraleap's library is installed: " << library->path;
  EXPECT_THAT(library.error().what,
              AllOf(HasSubstr("install"), HasSubstr("pose.leapc.library"), Not(HasSubstr("/usr"))));
}

TEST(LeapcLibrary, AnOldOneIsRefusedWithItsVersion) {
  EXPECT_THAT(why_not(FAKE_LEAPC_OLD), AllOf(HasSubstr("version 4.4.0"), HasSubstr("5 or later")));
}

TEST(LeapcLibrary, AnIncompleteOneIsRefusedWithWhatIsMissing) {
  EXPECT_THAT(why_not(FAKE_LEAPC_INCOMPLETE), HasSubstr("it lacks LeapSetTrackingMode"));
}

TEST(LeapcLibrary, SomethingElseIsRefused) {
  const test::Scratch scratch;
  const auto file = scratch.path() / "libLeapC.so";
  std::ofstream(file) << "not a library";
  EXPECT_THAT(why_not(file), HasSubstr("cannot be loaded"));
  EXPECT_THAT(why_not("/usr/lib/x86_64-linux-gnu/libm.so.6"), HasSubstr("it lacks LeapGetNow"));
}

TEST(LeapcLibrary, ItsAbsenceIsAnErrorOfTheRig) {
  auto rig = leapc_rig();
  rig.pose.leapc.library = "/nowhere";
  const auto source = open_pose_source(rig, calib::reference_rig(), now_ns());
  ASSERT_FALSE(source);
  EXPECT_THAT(source.error().what, HasSubstr("pose 'leapc': /nowhere"));
}

TEST(CopyMemory, WhatCannotBeReadIsFalseAndNotTheEnd) {
  int to = 0;
  const int from = 7;
  EXPECT_TRUE(copy_memory(&from, to));
  EXPECT_EQ(to, 7);
  EXPECT_FALSE(copy_memory(static_cast<const int*>(nullptr), to));
  const char* nowhere = reinterpret_cast<const char*>(&from) - (std::size_t{1} << 46);
  EXPECT_FALSE(copy_memory(nowhere, &to, sizeof to));
}

}  // namespace
}  // namespace handcast::pose::leapc
