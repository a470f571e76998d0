// SPDX-License-Identifier: Apache-2.0
#include "services/watch/tally.hpp"

#include <gmock/gmock.h>

#include "ipc/msg/light_source.hpp"
#include "tests/services/watch/a_day.hpp"

namespace handcast::watch {
namespace {

using test::at_s;
using test::kNoon;

class TallyTest : public testing::Test {
 protected:
  void SetUp() override { test::use_utc(); }

  static msg::StageMarks frame(double image_s, double light_s, std::uint32_t refreshes) {
    msg::StageMarks marks;
    marks.made_from.image_ns = at_s(image_s);
    marks.count = 1;
    marks.marks[0] = {msg::Stage::light,
                      msg::detail_of(msg::LightNote{msg::LightSource::kernel, refreshes}), 0,
                      at_s(light_s)};
    return marks;
  }
  static msg::HandPoses hands(double time_s, std::uint32_t count, float confidence = 1) {
    msg::HandPoses poses;
    poses.header.origin_ns = at_s(time_s);
    poses.count = count;
    poses.hands[0].confidence = confidence;
    return poses;
  }
  static RigStatus died(int restarts, const std::string& why) {
    RigStatus status;
    status.services["pose"] = {.state = "ready", .reason = why, .restarts = restarts};
    return status;
  }

  Day day_;
  Tally tally_{day_, 7, at_s(100), kNoon};
};

TEST_F(TallyTest, TheTimesFromImageToLightAndMissedRefreshesAreCounted) {
  tally_.add(frame(1, 1.012, 1));
  tally_.add(frame(2, 2.05, 4));
  tally_.add(msg::StageMarks{});  // a heartbeat
  EXPECT_EQ(day_.frames, 2u);
  EXPECT_EQ(day_.missed_refreshes, 3u);
  EXPECT_NEAR(day_.latencies.worst_ms, 50, 0.1);
  EXPECT_NEAR(day_.latencies.quantile_ms(0.5), 12, 0.1);
}

TEST_F(TallyTest, HandsThatLeaveAndComeBackAreAnotherVisit) {
  for (int i = 0; i <= 100; ++i) tally_.add(hands(10 + 0.1 * i, 1));
  tally_.add(hands(20.5, 0));
  tally_.add(hands(22, 1));  // the same visit: the tracker had lost them
  tally_.add(hands(23, 1, 0.01F));
  tally_.add(hands(60, 2));
  EXPECT_EQ(day_.visits, 2);
  EXPECT_NEAR(day_.hands_s, 10.25, 0.01);
  EXPECT_NEAR(day_.longest_visit_s, 12, 0.01);
}

TEST_F(TallyTest, RestartsAreCountedByServiceAndReason) {
  tally_.add(died(0, ""), kNoon);
  tally_.add(died(1, "exit 111"), kNoon);
  tally_.add(died(1, "exit 111"), kNoon);
  tally_.add(died(3, "signal 9"), kNoon);
  EXPECT_EQ(day_.restarts["pose"]["exit 111"], 1);
  EXPECT_EQ(day_.restarts["pose"]["signal 9"], 2);
}

TEST_F(TallyTest, AWatchThatIsStartedAgainCountsNothingTwiceAndNoOtherStart) {
  tally_.add(died(3, "signal 9"), kNoon);
  tally_.pass(at_s(104), kNoon + 4, {});
  Tally again(day_, 7, at_s(110), kNoon + 10);
  again.add(died(3, "signal 9"), kNoon + 10);
  EXPECT_EQ(day_.restarts["pose"]["signal 9"], 3);
  EXPECT_EQ(day_.starts, 1);
  EXPECT_NEAR(day_.up_s, 10, 0.01);  // the rig was up meanwhile
}

TEST_F(TallyTest, ARigThatIsStartedAgainCountsFromZeroAndHasItsLightToldAnew) {
  tally_.add(died(3, "signal 9"), kNoon);
  tally_.pass(at_s(104), kNoon + 4, {});
  day_.lights = false;
  Tally again(day_, 8, at_s(3700), kNoon + 3600);
  again.add(died(1, "signal 9"), kNoon + 3600);
  EXPECT_EQ(day_.restarts["pose"]["signal 9"], 4);
  EXPECT_EQ(day_.starts, 2);
  EXPECT_NEAR(day_.up_s, 4, 0.01);
  EXPECT_FALSE(day_.lights);
}

TEST_F(TallyTest, TimeIsLitOrDarkAndAFaultIsSeenForItsMinute) {
  tally_.pass(at_s(101), kNoon, {.is_dark = false});
  tally_.pass(at_s(103), kNoon + 2, {.is_dark = true, .has_fault = true});
  tally_.pass(at_s(104), kNoon + 3, {.is_dark = true});
  tally_.pass(at_s(105), kNoon + 60, {.is_dark = true});
  EXPECT_NEAR(day_.lit_s, 1, 0.01);
  EXPECT_NEAR(day_.dark_s, 4, 0.01);
  EXPECT_EQ(day_.minutes.substr(719, 4), " fd ");
}

TEST_F(TallyTest, ATimeInWhichTheComputerSleptIsNoUpTime) {
  tally_.pass(at_s(10'000), kNoon + 9'900, {});
  EXPECT_LT(day_.up_s, 10);
}

}  // namespace
}  // namespace handcast::watch
