// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/exit_code.hpp"

#include <gtest/gtest.h>

namespace handcast {
namespace {

TEST(ExitCode, TheNumbersAreThoseThatScriptsAndUnitFilesKnow) {
  EXPECT_EQ(kExitDone, 0);
  EXPECT_EQ(kExitBadResult, 1);
  EXPECT_EQ(kExitUsage, 2);
  EXPECT_EQ(kExitConfig, 100);
  EXPECT_EQ(kExitRetry, 111);
}

TEST(ExitCode, WhatOnlyAPersonCanChangeIsToldFromWhatMayPass) {
  EXPECT_EQ(exit_code_of(Errc::bad_config), kExitConfig);
  EXPECT_EQ(exit_code_of(Errc::bad_data), kExitConfig) << "a damaged file stays damaged";
  EXPECT_EQ(exit_code_of(Errc::unavailable), kExitRetry);
  EXPECT_EQ(exit_code_of(Errc::disconnected), kExitRetry);
  EXPECT_EQ(exit_code_of(Errc::timeout), kExitRetry);
}

}  // namespace
}  // namespace handcast
