// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/programs.hpp"

#include <gmock/gmock.h>

#include "tests/scratch.hpp"

namespace handcast::calibrate {
namespace {

TEST(CalibrationPage, ThatCannotBeMadeIsToldWithItsReason) {
  const test::Scratch scratch;
  const auto page = write_page(scratch.path());
  ASSERT_FALSE(page);
  EXPECT_EQ(page.error().code, Errc::unavailable);
  EXPECT_EQ(page.error().what, (scratch.path() / "report.json").string() +
                                   ": cannot be read: No such file or directory");
}

}  // namespace
}  // namespace handcast::calibrate
