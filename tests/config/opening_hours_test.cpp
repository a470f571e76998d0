// SPDX-License-Identifier: Apache-2.0
#include "config/opening_hours.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "config/rig.hpp"

namespace handcast::config {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// In Central European Time, whatever the computer's is.
class OpeningHoursTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* zone = std::getenv("TZ")) before_ = zone;
    ::setenv("TZ", "CET-1CEST,M3.5.0,M10.5.0/3", 1);
    ::tzset();
  }
  void TearDown() override {
    before_.empty() ? ::unsetenv("TZ") : ::setenv("TZ", before_.c_str(), 1);
    ::tzset();
  }

  static OpeningHours hours(const std::vector<std::string>& sentences) {
    auto parsed = OpeningHours::parse(sentences);
    EXPECT_TRUE(parsed) << parsed.error().what;
    return parsed ? std::move(*parsed) : OpeningHours();
  }
  /// Local time, "2026-06-01 10:00".
  static std::time_t at(const std::string& text) {
    std::tm local{};
    EXPECT_NE(::strptime(text.c_str(), "%Y-%m-%d %H:%M", &local), nullptr);
    local.tm_isdst = -1;
    return std::mktime(&local);
  }
  static std::string fault(const std::string& sentence) {
    const std::vector<std::string> one{sentence};
    const auto parsed = OpeningHours::parse(one);
    return parsed ? "" : parsed.error().what;
  }
  std::string before_;
};

TEST_F(OpeningHoursTest, DaysOfTheWeekHaveTheirRanges) {
  const auto week = hours({"mon-fri 10:00-12:30, 14:00-18:00", "sat,sun 10:00-20:00"});
  EXPECT_FALSE(week.is_open(at("2026-06-01 09:59")));  // a Monday
  EXPECT_TRUE(week.is_open(at("2026-06-01 10:00")));
  EXPECT_FALSE(week.is_open(at("2026-06-01 12:30")));
  EXPECT_TRUE(week.is_open(at("2026-06-05 17:59")));
  EXPECT_FALSE(week.is_open(at("2026-06-05 18:00")));
  EXPECT_TRUE(week.is_open(at("2026-06-06 19:00")));
  EXPECT_TRUE(week.is_open(at("2026-06-07 19:00")));
  EXPECT_FALSE(week.is_open(at("2026-06-08 19:00")));
}

TEST_F(OpeningHoursTest, NoSentenceIsAlwaysOpen) {
  EXPECT_TRUE(hours({}).is_always_open());
  EXPECT_TRUE(hours({}).is_open(at("2026-06-01 03:00")));
  EXPECT_FALSE(hours({"12-24 closed"}).is_always_open());
  EXPECT_TRUE(hours({"12-24 closed"}).is_open(at("2026-06-01 03:00")));
}

TEST_F(OpeningHoursTest, ADayThatIsNotNamedIsClosed) {
  EXPECT_FALSE(hours({"tue-sun 10:00-18:00"}).is_open(at("2026-06-01 12:00")));
  EXPECT_TRUE(hours({"sun-tue 10:00-18:00"}).is_open(at("2026-06-01 12:00")));
}

TEST_F(OpeningHoursTest, ADateGoesBeforeItsDayAndOneOfAYearBeforeOneOfEach) {
  const auto year = hours({"2026-12-31 10:00-14:00", "daily 10:00-18:00", "12-24..12-26 closed",
                           "12-31 closed", "12-30..01-02 closed"});
  EXPECT_TRUE(year.is_open(at("2026-12-23 15:00")));
  EXPECT_FALSE(year.is_open(at("2026-12-24 15:00")));
  EXPECT_FALSE(year.is_open(at("2031-12-26 15:00")));
  EXPECT_TRUE(year.is_open(at("2026-12-31 13:00")));
  EXPECT_FALSE(year.is_open(at("2026-12-31 15:00")));
  EXPECT_FALSE(year.is_open(at("2027-12-31 13:00")));
  EXPECT_FALSE(year.is_open(at("2027-01-02 13:00")));
  EXPECT_TRUE(year.is_open(at("2027-01-03 13:00")));
}

TEST_F(OpeningHoursTest, ARangeMayPassMidnightAndBelongsToTheDayOnWhichItBegins) {
  const auto late = hours({"fri 20:00-02:00", "2026-06-13 closed"});
  EXPECT_FALSE(late.is_open(at("2026-06-05 01:00")));
  EXPECT_TRUE(late.is_open(at("2026-06-05 23:59")));
  EXPECT_TRUE(late.is_open(at("2026-06-06 01:59")));
  EXPECT_FALSE(late.is_open(at("2026-06-06 02:00")));
  EXPECT_TRUE(late.is_open(at("2026-06-13 01:00")));  // of the day before
  EXPECT_TRUE(hours({"daily 00:00-24:00"}).is_open(at("2026-06-13 23:59")));
}

TEST_F(OpeningHoursTest, TheClockOnTheWallCountsWhenItIsChanged) {
  const auto day = hours({"daily 10:00-18:00"});
  // 23 hours lie between the same times of these days, and 25 between those.
  const auto spring = at("2026-03-28 10:00") + 23 * 3600,
             autumn = at("2026-10-24 10:00") + 25 * 3600;
  for (const auto opening : {spring, autumn}) {
    EXPECT_FALSE(day.is_open(opening - 60));
    EXPECT_TRUE(day.is_open(opening));
  }
  // What begins in the hour that there is not begins after it.
  const auto night = hours({"sun 02:30-05:00"});
  EXPECT_FALSE(night.is_open(at("2026-03-29 01:59")));
  EXPECT_TRUE(night.is_open(at("2026-03-29 03:00")));
  // The day before the one that has 23 hours is the day before.
  EXPECT_TRUE(hours({"sat 20:00-04:00"}).is_open(at("2026-03-29 03:30")));
  EXPECT_TRUE(hours({"sun 20:00-01:00"}).is_open(at("2026-03-30 00:30")));
}

TEST_F(OpeningHoursTest, ASentenceThatCannotBeReadIsNamed) {
  for (const auto* wrong :
       {"", "mon", "mon 10-18", "mon 10:00", "mon 10:00-10:00", "mon 10:00-25:00", "mon 9:00-18:00",
        "mon 10:00-18:60", "mon 24:00-02:00", "mon 10:00-18:00 sharp", "mon open"})
    EXPECT_THAT(fault(wrong), AllOf(HasSubstr("says no hours"), HasSubstr("10:00-18:00"))) << wrong;
  for (const auto* wrong : {"monday 10:00-18:00", "mon- 10:00-18:00", "2026-13-01 closed",
                            "2026-02-30 closed", "24.12. closed", "2026-12-24..12-26 closed",
                            "2026-12-26..2026-12-24 closed", "26-12-24 closed", "1-1 closed"})
    EXPECT_THAT(fault(wrong), AllOf(HasSubstr("no day"), HasSubstr("2026-12-24"))) << wrong;
}

TEST_F(OpeningHoursTest, ARigFileWithABadSentenceIsRefused) {
  const auto rig = parse_rig("[watch]\nhours = [\"mon 10-18\"]\n", "/rigs/test.toml");
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, AllOf(HasSubstr("watch.hours"), HasSubstr("'mon 10-18'")));
}

}  // namespace
}  // namespace handcast::config
