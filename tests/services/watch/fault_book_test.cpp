// SPDX-License-Identifier: Apache-2.0
#include "services/watch/fault_book.hpp"

#include <gmock/gmock.h>

#include "tests/services/watch/a_day.hpp"

namespace handcast::watch {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A fault an hour; well after a minute.
class FaultBookTest : public testing::Test {
 protected:
  void SetUp() override { test::use_utc(); }
  /// What is told so many seconds after noon.
  std::vector<std::string> told(int second, const Wrongs& wrongs) {
    std::vector<std::string> texts;
    for (const auto& notice :
         book_.look(wrongs, 1'000'000'000LL * (second + 1000), test::kNoon + second))
      texts.push_back(notice.text);
    return texts;
  }
  const Wrongs pose_{{"service pose", "pose dies"}}, disk_{{"disk", "the disk is full"}};
  Day day_;
  FaultBook book_{day_, {.again_s = 3600, .well_s = 60}};
};

TEST_F(FaultBookTest, AFaultIsToldOnceAndItsEndOnce) {
  EXPECT_THAT(told(0, pose_), ElementsAre("pose dies (since 2026-12-24 12:00:00)"));
  for (int second = 1; second < 100; ++second) EXPECT_THAT(told(second, pose_), IsEmpty());
  for (int second = 100; second < 159; ++second) EXPECT_THAT(told(second, {}), IsEmpty());
  EXPECT_THAT(told(160, {}), ElementsAre(AllOf(HasSubstr("it is over: pose dies"),
                                               HasSubstr("12:00:00 to 2026-12-24 12:02:40"))));
  for (int second = 161; second < 300; ++second) EXPECT_THAT(told(second, {}), IsEmpty());
  ASSERT_EQ(day_.faults.size(), 1u);
  EXPECT_EQ(day_.faults[0].until, "2026-12-24 12:02:40");
}

TEST_F(FaultBookTest, OneThatComesAndGoesIsOneFaultWhileItIsNotWell) {
  told(0, pose_);
  for (int second = 1; second < 300; ++second)
    EXPECT_THAT(told(second, second % 50 == 0 ? pose_ : Wrongs{}), IsEmpty());
  EXPECT_EQ(day_.faults.size(), 1u);
}

TEST_F(FaultBookTest, TheSameKindIsToldAtMostOnceAnHourAndItsEndOnlyIfItWas) {
  EXPECT_THAT(told(0, pose_), testing::SizeIs(1));
  told(1, {});
  EXPECT_THAT(told(61, {}), testing::SizeIs(1));
  EXPECT_THAT(told(100, pose_), IsEmpty());
  told(101, {});
  EXPECT_THAT(told(200, {}), IsEmpty());
  EXPECT_EQ(day_.faults.size(), 2u);
  // One that goes on is told when the hour is over.
  EXPECT_THAT(told(300, pose_), IsEmpty());
  EXPECT_THAT(told(3599, pose_), IsEmpty());
  EXPECT_THAT(told(3600, pose_), ElementsAre(HasSubstr("since 2026-12-24 12:05:00")));
}

TEST_F(FaultBookTest, KindsDoNotSilenceEachOther) {
  told(0, pose_);
  EXPECT_THAT(told(1, disk_), ElementsAre(HasSubstr("disk")));
}

TEST_F(FaultBookTest, ABookThatIsOpenedAgainGoesOn) {
  told(0, pose_);
  FaultBook again(day_, {.again_s = 3600, .well_s = 60});
  EXPECT_THAT(again.look(pose_, 5, test::kNoon + 5), IsEmpty());
  EXPECT_THAT(again.look({}, 6, test::kNoon + 6), IsEmpty());
  EXPECT_THAT(again.look({}, 66'000'000'000, test::kNoon + 66), testing::SizeIs(1));
}

TEST_F(FaultBookTest, AClockThatIsSetBackSilencesNothing) {
  told(0, pose_);
  told(1, {});
  told(100, {});
  EXPECT_THAT(told(-90'000, disk_), testing::SizeIs(1));
  EXPECT_THAT(told(-86'400, {*pose_.begin(), *disk_.begin()}), testing::SizeIs(1));
}

TEST_F(FaultBookTest, FaultsOfADayAreBounded) {
  for (int i = 0; i < 1000; ++i) told(0, {{"kind " + std::to_string(i), "odd"}});
  EXPECT_EQ(day_.faults.size(), Day::kMostFaults);
}

}  // namespace
}  // namespace handcast::watch
