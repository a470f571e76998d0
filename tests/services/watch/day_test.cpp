// SPDX-License-Identifier: Apache-2.0
#include "services/watch/day.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch.hpp"
#include "tests/services/watch/a_day.hpp"

namespace handcast::watch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Day, IsReadAsItWasWritten) {
  test::use_utc();
  const auto written = to_json(test::full_day());
  const auto day = day_in(written);
  ASSERT_TRUE(day) << day.error().what;
  EXPECT_EQ(to_json(*day), written);
  EXPECT_EQ(day->lights, false);
  EXPECT_EQ(day->faults.size(), 2u);
  EXPECT_FALSE(day_in(to_json(Day{}))->lights);
}

TEST(Day, OneThatIsDamagedOrOfANewerVersionIsRefused) {
  EXPECT_EQ(day_in("").error().code, Errc::bad_data);
  EXPECT_EQ(day_in("{}").error().code, Errc::bad_data);
  auto newer = to_json(Day{});
  newer.replace(newer.find("\"format\":1"), 10, "\"format\":2");
  EXPECT_THAT(day_in(newer).error().what, HasSubstr("newer version"));
}

TEST(Day, TheNextOneGoesOnWithWhatIsOpenAndCountsFromZero) {
  const auto next = test::full_day().next("2026-12-25");
  EXPECT_EQ(next.date, "2026-12-25");
  EXPECT_EQ(next.up_s, 0);
  EXPECT_TRUE(next.restarts.empty());
  ASSERT_EQ(next.faults.size(), 1u);
  EXPECT_EQ(next.faults[0].kind, "disk");
  EXPECT_EQ(next.lights, false);
  EXPECT_EQ(next.counted.at("pose"), 4);
  EXPECT_EQ(next.alerted.at("disk"), test::kNoon);
}

TEST(Day, LatenciesHaveQuantiles) {
  const auto& latencies = test::full_day().latencies;
  EXPECT_NEAR(latencies.quantile_ms(0.5), 12.3, 0.051);
  EXPECT_NEAR(latencies.quantile_ms(0.99), 12.3, 0.051);
  EXPECT_NEAR(latencies.quantile_ms(1), 80, 0.051);
  EXPECT_EQ(latencies.worst_ms, 80);
  EXPECT_EQ(Latencies().quantile_ms(0.5), 0);
}

TEST(Day, EventsAreBounded) {
  Day day;
  for (int i = 0; i < 10'000; ++i) day.note(i, std::to_string(i));
  EXPECT_LE(day.events.size(), 1000u);
  EXPECT_EQ(day.events.back().text, "9999");
}

TEST(DayFiles, OnlyTheNewestDaysAreKept) {
  const ::handcast::test::Scratch folder;
  for (const auto* name : {"2026-12-22.json", "2026-12-22.html", "2026-12-23.json",
                           "2026-12-24.json", "notes.json", "a.txt"})
    std::ofstream(folder.path() / name) << "x";
  keep_days(folder.path(), 2);
  EXPECT_THAT(dates_in(folder.path()), ElementsAre("2026-12-23", "2026-12-24"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "2026-12-22.html"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "notes.json"));
  keep_days(folder.path() / "absent", 2);
}

TEST(DayFiles, ADayThatIsNotThereIsNoFaultAndOneThatIsDamagedIs) {
  const ::handcast::test::Scratch folder;
  ASSERT_TRUE(load_day(folder.path(), "2026-12-24"));
  EXPECT_FALSE(*load_day(folder.path(), "2026-12-24"));
  std::ofstream(json_file(folder.path(), "2026-12-24")) << "{";
  EXPECT_THAT(load_day(folder.path(), "2026-12-24").error().what, HasSubstr("2026-12-24.json"));
}

}  // namespace
}  // namespace handcast::watch
