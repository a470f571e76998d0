// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/runtime/first_at.hpp"
#include "services/runtime/loop.hpp"

namespace handcast::timing {
namespace {

Loop loop_of(std::vector<std::int64_t> times_ns, bool repeat = true) {
  return *Loop::make(std::move(times_ns), {}, 1000, repeat, 10);
}

TEST(FirstAt, FindsTheFirstThatIsNotEarlier) {
  const auto tens = [](std::uint64_t k) { return static_cast<std::int64_t>(k) * 10; };
  EXPECT_EQ(first_at(0, -5, tens), 0u);
  EXPECT_EQ(first_at(0, 0, tens), 0u);
  EXPECT_EQ(first_at(0, 1, tens), 1u);
  EXPECT_EQ(first_at(0, 1'000'000, tens), 100'000u);
  EXPECT_EQ(first_at(0, 1'000'001, tens), 100'001u);
}

TEST(FirstAt, NeverGoesBackBeforeWhereItStarted) {
  EXPECT_EQ(first_at(7, 0, [](std::uint64_t k) { return static_cast<std::int64_t>(k); }), 7u);
}

TEST(Loop, StartsAtItsStartWhateverTheFirstTimeStampSays) {
  const auto item = loop_of({500, 510, 530}).at_or_after(0);
  ASSERT_TRUE(item);
  EXPECT_EQ(item->index, 0u);
  EXPECT_EQ(item->due_ns, 1000);
}

TEST(Loop, TheNextLapFollowsAMeanStepAfterTheLastItem) {
  const Loop loop = loop_of({0, 10, 30});  // mean step 15: a lap takes 45
  const auto last = loop.at_or_after(1011);
  const auto again = loop.at_or_after(1031);
  EXPECT_EQ(last->index, 2u);
  EXPECT_EQ(again->index, 0u);
  EXPECT_EQ(again->number, 3u);
  EXPECT_EQ(again->due_ns, 1045);
  EXPECT_EQ(loop.at_or_after(1046)->due_ns, 1055);
}

TEST(Loop, OneItemRepeatsAtItsLoneStep) {
  EXPECT_EQ(loop_of({77}).at_or_after(1001)->due_ns, 1010);
}

TEST(Loop, EndsWhereItIsNotToRepeat) {
  const Loop once = loop_of({0, 10}, false);
  EXPECT_TRUE(once.at_or_after(1010));
  EXPECT_FALSE(once.at_or_after(1011));
}

TEST(Loop, TheNearestItemMayBeTheLastOfTheLapBefore) {
  const Loop loop = loop_of({0, 10, 30});
  EXPECT_EQ(loop.nearest(1004)->index, 0u);
  EXPECT_EQ(loop.nearest(1006)->index, 1u);
  EXPECT_EQ(loop.nearest(1036)->index, 2u);
  EXPECT_EQ(loop.nearest(1039)->number, 3u);
}

TEST(Lap, LastsFromTheEarliestItemUntilTheLastSensorIsThrough) {
  const auto lap = Lap::of({{20, 40, 60}, {}, {10, 40}});
  EXPECT_EQ(lap.first_ns, 10);
  EXPECT_EQ(lap.length_ns, 70);
  EXPECT_EQ(Lap::of({{20}, {0, kLoneStep_ns / 2}}).length_ns, 20 + kLoneStep_ns);
}

TEST(Loop, ItsItemsLieInALapOfTheWholeRecordingWhereTheyWereTaken) {
  const Loop loop = *Loop::make({530, 540}, {.first_ns = 500, .length_ns = 100}, 1000, true, 10);
  EXPECT_EQ(loop.at_or_after(0)->due_ns, 1030);
  EXPECT_EQ(loop.at_or_after(1041)->due_ns, 1130);
  EXPECT_EQ(loop.at_or_after(1041)->number, 2u);
  EXPECT_EQ(loop.nearest(1084)->index, 1u);
  EXPECT_EQ(loop.nearest(1086)->index, 0u);
  const Loop longer = *Loop::make({530, 590}, {.first_ns = 500, .length_ns = 100}, 1000, true, 10);
  EXPECT_EQ(longer.at_or_after(1091)->due_ns, 1180) << "530 to 590 and a mean step: until 650";
}

TEST(Loop, RefusesNoItemsAndTimesThatStandStill) {
  EXPECT_EQ(Loop::make({}, {}, 0, true, 10).error().code, Errc::bad_config);
  EXPECT_EQ(Loop::make({5, 5}, {}, 0, true, 10).error().code, Errc::bad_config);
}

}  // namespace
}  // namespace handcast::timing
