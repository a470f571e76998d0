// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "supervisor/look/top/top_layout.hpp"
#include "supervisor/look/top/top_model.hpp"
#include "supervisor/look/top/top_table.hpp"
#include "supervisor/look/top/top_terminal.hpp"
#include "supervisor/look/top/units_text.hpp"
#include "tests/supervisor/look/top/rig_looks.hpp"

namespace handcast::supervisor {
namespace {

using test::look_at;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

TopModel two_seconds() { return compare(look_at(10), look_at(12)); }

std::vector<std::string> plain(const std::vector<Line>& lines) {
  std::vector<std::string> texts;
  for (const auto& line : lines) texts.push_back(print(line, false));
  return texts;
}

/// The style of the first piece of text that holds `text`.
Style style_of(const std::vector<Line>& lines, std::string_view text) {
  for (const auto& line : lines)
    for (const auto& span : line)
      if (span.text.find(text) != std::string::npos) return span.style;
  ADD_FAILURE() << text << " is not there";
  return Style::plain;
}

TEST(TopModel, RatesAreBetweenTwoLooks) {
  const auto model = two_seconds();
  EXPECT_DOUBLE_EQ(model.services[0].cores.value(), 0.25);
  EXPECT_DOUBLE_EQ(model.rings[0].rate_hz.value(), 240);
  EXPECT_DOUBLE_EQ(model.rings[0].readers[0].received_hz.value(), 120);
  EXPECT_DOUBLE_EQ(model.rings[0].readers[0].skipped_hz.value(), 120);
  EXPECT_EQ(model.rings[0].newest_age_ns, 2'000'000);
  EXPECT_EQ(model.rings[0].latency_ns, 3'000'000);
}

TEST(TopModel, ReadersHaveTheNameOfTheirServiceElseOfTheirProgram) {
  const auto readers = two_seconds().rings[0].readers;
  EXPECT_EQ(readers[0].who, "projector");
  EXPECT_EQ(readers[1].who, "recorder\x1b");
  EXPECT_TRUE(readers[2].gone);
  EXPECT_FALSE(readers[1].gone);
}

TEST(TopModel, ThereIsNoRateAcrossAChangeOfHands) {
  const auto before = look_at(10);
  auto now = look_at(12);
  now.rings[0].published = 5;
  now.rings[0].readers[0].pid = 77;
  now.processes[test::kCameraPid].started_ticks = 6;
  const auto model = compare(before, now);
  EXPECT_FALSE(model.rings[0].rate_hz);
  EXPECT_FALSE(model.rings[0].readers[0].received_hz);
  EXPECT_FALSE(model.services[0].cores);
}

TEST(TopModel, TheSharesOfRungsAreOfTheHandsDrawnBetweenTheLooks) {
  const auto rungs = two_seconds().rungs;
  ASSERT_EQ(rungs.size(), 2u) << "those that were taken";
  EXPECT_EQ(rungs[0].rung, "landmarks");
  EXPECT_DOUBLE_EQ(rungs[0].share, 0.75);
  EXPECT_EQ(rungs[1].rung, "register");
  EXPECT_TRUE(compare(look_at(10), look_at(2)).rungs.empty())
      << "counted anew: the supervisor was started again";
}

TEST(TopModel, ARingIsLateAfterThreePeriods) {
  auto now = look_at(12);
  EXPECT_FALSE(compare(look_at(10), now).rings[0].late());
  now.rings[0].newest_published_ns = now.taken_ns - 13'000'000;  // 3 periods of 240 Hz are 12.5 ms
  EXPECT_TRUE(compare(look_at(10), now).rings[0].late());
  now.rings[0].newest_published_ns = 0;  // nothing was published yet
  EXPECT_FALSE(compare(look_at(10), now).rings[0].late());
}

TEST(TopModel, ALeaseOfMoreThanATenthOfASecondIsOld) {
  ReaderRow row;
  row.now.lease_ages_ns = {-1, 99'000'000};
  EXPECT_FALSE(row.holds_an_old_lease());
  row.now.lease_ages_ns = {-1, 101'000'000};
  EXPECT_TRUE(row.holds_an_old_lease());
}

TEST(TopModel, ARigWithoutAnAnswerIsEmptyNotACrash) {
  const RigLook nothing{.rig = "paper", .taken_ns = 5, .missing = "nobody answers"};
  const auto model = compare(nothing, nothing);
  EXPECT_TRUE(model.services.empty());
  EXPECT_THAT(plain(lay_out(model, {}))[0], HasSubstr("nobody answers"));
}

TEST(TopModel, ServicesThatWentWithTheirSupervisorAreGone) {
  auto now = look_at(12);
  now.missing = "nobody answers";
  now.processes.erase(test::kProjectorPid);
  const auto model = compare(look_at(10), now);
  EXPECT_EQ(model.services[0].state, "ready");
  EXPECT_EQ(model.services[1].state, "gone");
}

TEST(TopModel, AsJsonItHasEveryServiceAndReader) {
  const auto json = json_of(two_seconds());
  EXPECT_EQ(json["services"].size(), 2u);
  EXPECT_EQ(json["services"][0]["cores"], 0.25);
  EXPECT_EQ(json["services"][1]["trouble"],
            "died 10 times; again in 2.5 s: projector: no \x1b[31mlamp");
  EXPECT_EQ(json["rungs"]["register"], 0.25);
  EXPECT_EQ(json["lost_images"].dump(), R"({"skipped":6.0})") << "since the last look";
  EXPECT_EQ(json["rings"][0]["readers"].size(), 3u);
  EXPECT_EQ(json["rings"][0]["readers"][0]["who"], "projector");
}

TEST(TopLayout, ShowsWhatAPersonLooksFor) {
  const auto lines = plain(lay_out(two_seconds(), {.columns = 200}));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("camera"), HasSubstr("ready"), HasSubstr("25.0 %"),
                                    HasSubstr("38 MiB"), HasSubstr("102"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("projector"), HasSubstr("degraded"), HasSubstr("12"),
                                    HasSubstr("Segmentation fault"))));
  EXPECT_THAT(lines,
              Contains(HasSubstr("└ died 10 times; again in 2.5 s: projector: no ?[31mlamp")));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("camera.frames"), HasSubstr("240 Hz"),
                                    HasSubstr("2 ms"), HasSubstr("writer 3"))));
  EXPECT_THAT(lines,
              Contains(AllOf(HasSubstr("├ projector"), HasSubstr("120 Hz"), HasSubstr("+120/s"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("├ recorder?"), HasSubstr("sleeps"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("└ ?"), HasSubstr("gone"))));
  EXPECT_THAT(lines, Contains("RUNGS  landmarks 75.0 %  register 25.0 %"));
}

TEST(TopLayout, WhatIsNotWellStandsOut) {
  auto now = look_at(12);
  now.rings[0].newest_published_ns -= 100'000'000;
  now.rings[0].dropped = 4;
  now.rings[0].readers[0].lease_ages_ns = {150'000'000, -1};
  const auto lines = lay_out(compare(look_at(10), now), {.columns = 200});
  EXPECT_EQ(style_of(lines, "degraded"), Style::bad);
  EXPECT_EQ(style_of(lines, "102 ms"), Style::warning);
  EXPECT_EQ(style_of(lines, "holds 150 ms"), Style::warning);
  EXPECT_EQ(style_of(lines, "+2/s"), Style::bad);
  EXPECT_EQ(style_of(lines, "+120/s"), Style::warning);
  EXPECT_EQ(style_of(lines, "gone"), Style::bad);
  EXPECT_EQ(style_of(lines, "ready"), Style::good);
}

TEST(TopLayout, NoLineIsWiderThanTheScreen) {
  for (std::size_t columns = 1; columns < 220; ++columns)
    for (const auto& line : lay_out(two_seconds(), {.columns = columns})) {
      std::size_t width = 0;
      for (const auto& span : line) width += columns_of(span.text);
      ASSERT_LE(width, columns);
    }
}

TEST(TopLayout, OnANarrowScreenTheImportantColumnsStay) {
  const auto lines = plain(lay_out(two_seconds(), {.columns = 40}));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("SERVICE"), HasSubstr("STATE"), HasSubstr("CPU"),
                                    Not(HasSubstr("THREADS")))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("RING"), HasSubstr("RATE"), HasSubstr("AGE"))));
}

TEST(TopLayout, StageMarksAreLeftOutWhereNotAskedFor) {
  const auto with = plain(lay_out(two_seconds(), {.columns = 120, .with_marks = true}));
  const auto without = plain(lay_out(two_seconds(), {.columns = 120, .with_marks = false}));
  EXPECT_THAT(with, Contains(HasSubstr("marks.camera")));
  EXPECT_THAT(without, Each(Not(HasSubstr("marks.camera"))));
}

TEST(TopLayout, ColoursAreOnlyWhereTheyAreAskedFor) {
  for (const auto& line : lay_out(two_seconds(), {}))
    EXPECT_THAT(print(line, false), Not(HasSubstr("\x1b")));
  EXPECT_EQ(print({{"a", Style::bad}, {"b"}}, true), "\x1b[1;31ma\x1b[0mb");
}

std::vector<Line> numbered(int count) {
  std::vector<Line> lines;
  for (int i = 0; i < count; ++i) lines.push_back({{std::to_string(i)}});
  return lines;
}

TEST(TopScreen, ScrollsUnderItsHeadAndNoFurtherThanTheEnd) {
  std::size_t first = 2;
  EXPECT_THAT(plain(fit(numbered(10), 80, 6, first)),
              ElementsAre("0", "1", "4", "5", "6", HasSubstr("2 above, 3 below")));
  first = 100;
  EXPECT_THAT(plain(fit(numbered(10), 80, 6, first)),
              ElementsAre("0", "1", "7", "8", "9", HasSubstr("5 above, 0 below")));
  EXPECT_EQ(first, 5u);
}

TEST(TopScreen, FillsScreensOfEverySize) {
  for (std::size_t rows = 1; rows < 30; ++rows)
    for (const int count : {1, 2, 3, 10}) {
      std::size_t first = 3;
      EXPECT_LE(fit(numbered(count), 80, rows, first).size(), rows);
    }
  std::size_t first = 0;
  EXPECT_THAT(fit(numbered(3), 80, 10, first), SizeIs(10));
}

TEST(TopScreen, KnowsItsKeys) {
  EXPECT_THAT(keys_in("q"), ElementsAre(Key::quit));
  EXPECT_THAT(keys_in("\x1b[Ax\x1b[Bm"), ElementsAre(Key::up, Key::down, Key::marks));
  EXPECT_THAT(keys_in("\x1b[5~\x1b[6~"), ElementsAre(Key::page_up, Key::page_down));
  EXPECT_TRUE(keys_in("\x1b[").empty());
}

}  // namespace
}  // namespace handcast::supervisor
