// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/board_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/solve/board/draw_board.hpp"
#include "ipc/base/clock.hpp"

namespace handcast::calibrate {
namespace {

TEST(ABoardThatIsHeld, WithItsNumbersExchangedIsNamedAfterSomeSecondsUntilItIsSeen) {
  const calib::Board held{calib::BoardKind::charuco, 7, 5, 20};
  BoardWatch watch({calib::BoardKind::charuco, 5, 7, 20});
  const auto picture = calib::draw_board(held, 40);
  const auto end = Deadline::in(std::chrono::seconds(60));
  EXPECT_EQ(watch.why_missing(), "");
  while (watch.why_missing().empty() && !end.passed()) {
    ASSERT_FALSE(watch.find(picture.view()));
    sleep_until_ns(now_ns() + 50'000'000);
  }
  EXPECT_THAT(watch.why_missing(), testing::HasSubstr("--board charuco:7x5:20"));

  const auto right = calib::draw_board({calib::BoardKind::charuco, 5, 7, 20}, 40);
  ASSERT_TRUE(watch.find(right.view()));
  EXPECT_EQ(watch.why_missing(), "");
}

}  // namespace
}  // namespace handcast::calibrate
