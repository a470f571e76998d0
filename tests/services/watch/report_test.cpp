// SPDX-License-Identifier: Apache-2.0
#include "services/watch/report.hpp"

#include <gmock/gmock.h>

#include "tests/services/watch/a_day.hpp"

namespace handcast::watch {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Report, SaysWhatHappened) {
  test::use_utc();
  EXPECT_THAT(
      report_text(test::full_day()),
      AllOf(HasSubstr("rig 'show', 2026-12-24"), HasSubstr("up         10 h 00 min, started 2 x"),
            HasSubstr("on for 8 h 00 min, dark for 2 h 00 min"),
            HasSubstr("12 visits, 1 h 02 min in all, the longest 1 min 35 s"),
            HasSubstr("usually 12.3 ms"), HasSubstr("worst 80 ms"),
            HasSubstr("7 without a new frame, of 1007"),
            HasSubstr("pose (1 x exit 111, 3 x signal 9 (Killed))"),
            HasSubstr("the tracker has moved"), HasSubstr("12.5 GB free of 100 GB"),
            HasSubstr("2026-12-24 10:00:00 to 10:01:00"), HasSubstr("2026-12-24_10-00-00"),
            HasSubstr("2026-12-23 09:00:00, and goes on"),
            HasSubstr("12:00:00  the rig was started")));
}

TEST(Report, OfADayWithoutLightIsReadable) {
  EXPECT_THAT(report_text(Day{}), AllOf(HasSubstr("no light"), HasSubstr("restarts   none"),
                                        HasSubstr("faults     none"), Not(HasSubstr("drift"))));
}

TEST(Report, ThePageNeedsNoOtherFileAndShowsTextsAsTheyAre) {
  const auto page = report_page(test::full_day());
  EXPECT_THAT(page, AllOf(HasSubstr("dies &#60;again&#62;"), Not(HasSubstr("dies <again>")),
                          Not(HasSubstr("http")), Not(HasSubstr("src=")), Not(HasSubstr("href"))));
  EXPECT_THAT(page, HasSubstr("<rect class=\"l\" x=\"600\" y=\"0\" width=\"60\""));
}

TEST(Report, SpansAreInWordsThatPeopleUse) {
  EXPECT_EQ(span_text(0), "0 s");
  EXPECT_EQ(span_text(59.4), "59 s");
  EXPECT_EQ(span_text(61), "1 min 01 s");
  EXPECT_EQ(span_text(36'125), "10 h 02 min");
  EXPECT_EQ(span_text(-1), "0 s");
}

}  // namespace
}  // namespace handcast::watch
