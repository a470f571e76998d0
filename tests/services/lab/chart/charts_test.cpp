// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>

#include "services/lab/chart/fault.hpp"
#include "services/lab/chart/ladder.hpp"
#include "services/lab/chart/stress.hpp"
#include "services/lab/chart/write.hpp"
#include "tests/scratch.hpp"
#include "tests/services/lab/chart/sweeps.hpp"

namespace handcast::chart {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class ChartsTest : public testing::Test {
 protected:
  Order order(std::vector<fs::path> results) const {
    return {std::move(results), out(), {"a <title>", "a machine", "a date"}};
  }
  fs::path out() const { return scratch_.path() / "deep" / "charts"; }
  std::vector<fs::path> all() const {
    return {write_ladder(scratch_.path()), write_stress(scratch_.path()),
            write_failures(scratch_.path())};
  }
  Results results() const { return *read_results(all()); }

  test::Scratch scratch_;
};

TEST_F(ChartsTest, ThePageHoldsEveryChartAndNeedsNothingElse) {
  const auto written = write_charts(order(all()));
  ASSERT_TRUE(written) << written.error().what;
  EXPECT_TRUE(written->lacking.empty());
  const auto page = text_of(written->page);
  for (const char* name : {"chart_a", "chart_b", "chart_b_faults", "chart_c"}) {
    EXPECT_THAT(page, HasSubstr(fmt::format("<section id=\"{}\">", name)));
    EXPECT_THAT(page, HasSubstr(fmt::format("id='{}_gpPt6'", name)))
        << "the chart must be drawn, with ids of its own";
    EXPECT_THAT(text_of(out() / fmt::format("{}.svg", name)), HasSubstr("</svg>"));
  }
  EXPECT_THAT(page,
              AllOf(HasSubstr("a &lt;title&gt;"), HasSubstr("a machine"), HasSubstr("a date")));
  for (const char* loads :
       {"<script", "<link", "<img", "@import", "url(http", "src=", "href='http", "href=\"http"})
    EXPECT_THAT(page, Not(HasSubstr(loads))) << loads;
}

TEST_F(ChartsTest, ChartsOfThePageFollowItsColoursAndFilesKeepTheirOwn) {
  ASSERT_TRUE(write_charts(order(all())));
  EXPECT_THAT(text_of(out() / "charts.html"),
              AllOf(HasSubstr("var(--ours)"), HasSubstr("prefers-color-scheme: dark")));
  EXPECT_THAT(text_of(out() / "chart_a.svg"), AllOf(Not(HasSubstr("var(--")), HasSubstr("#ffffff"),
                                                    HasSubstr("A. Speed against accuracy")));
}

TEST_F(ChartsTest, ChartAHasAPointPerMethodAndSpeedAndSaysWhatNothingBeats) {
  ASSERT_TRUE(write_charts(order(all())));
  const auto numbers = text_of(out() / "chart_a.csv");
  EXPECT_THAT(numbers, HasSubstr("natural speed,paper as published,cpu,8.9,4,2,,,,,1900,,1\n"));
  EXPECT_THAT(numbers, HasSubstr("natural speed,shift,cpu,6.3,5,3,,,,,760,yes,1\n"));
  EXPECT_THAT(numbers, HasSubstr("3 times as fast,handcast,cpu,6.8,6.3,1,,,,,1000,yes,1\n"));
  const auto drawing = text_of(out() / "chart_a.svg");
  EXPECT_THAT(drawing, AllOf(HasSubstr("natural speed"), HasSubstr("3 times as fast"),
                             HasSubstr("paper as published  4.0"), HasSubstr("3.08")));
}

TEST_F(ChartsTest, TheTimesOfFramesAreThoseOfThePlanThatMeasuresThemAlone) {
  auto files = all();
  EXPECT_FALSE(ladder_of(*read_results(files)).timed_alone);
  files.push_back(write_sweep(scratch_.path(), "times", "twin.speed,interior_mm_p95,frame_us_p50",
                              {"handcast,1,99,555,"}));
  const auto ladder = ladder_of(*read_results(files));
  EXPECT_TRUE(ladder.timed_alone);
  for (const auto& standing : ladder.at(1))
    if (standing.method.variant == "handcast") {
      EXPECT_EQ(standing.frame_us, 555);
      EXPECT_EQ(standing.p95_mm, 2.1) << "the errors are those of the ladder";
    }
}

TEST_F(ChartsTest, AMethodStandsAtTheTimeOfItsOwnFrameAndThePaperAtItsOwnLeg) {
  const std::string columns =
      "twin.speed,interior_mm_p95,motion_to_photon_ms,software_ms,frame_us_p50";
  const auto ladder = write_sweep(scratch_.path(), "ladder", columns,
                                  {"shift,1,5,6.9,1.2,9999,", "paper,1,4,8.9,3.19,9999,",
                                   "ideal,1,4,6.9,1.2,9999,", "handcast,1,4,6.9,1.2,9999,"});
  const auto times = write_sweep(
      scratch_.path(), "times", columns,
      {"shift,1,5,6.9,1.2,700,", "paper,1,4,8.9,3.19,1900,", "handcast,1,4,6.9,1.2,1000,"});
  const auto standings = ladder_of(*read_results({ladder, times})).at(1);
  ASSERT_EQ(standings.size(), 4u);
  EXPECT_NEAR(*standings[0].photon_ms, 6.4, 1e-9);
  EXPECT_NEAR(*standings[1].photon_ms, 8.9, 1e-9);
  EXPECT_NEAR(*standings[2].photon_ms, 6.7, 1e-9) << "ideal has the frame time of handcast";
  EXPECT_NEAR(*standings[3].photon_ms, 6.7, 1e-9);
}

TEST_F(ChartsTest, ARealDetectorStandsWithItsAgeAtTheTimeOfOurFrames) {
  const std::string columns =
      "twin.speed,interior_mm_mean,interior_mm_p95,motion_to_photon_ms,software_ms,frame_us_p50,"
      "detector_age_ms";
  const auto ladder = write_sweep(
      scratch_.path(), "ladder", columns,
      {"handcast,1,1,2,6.9,1.2,9999,16.2,", "handcast_network,1,2,4,6.9,1.2,9999,4.1,"});
  const auto times =
      write_sweep(scratch_.path(), "times", columns, {"handcast,1,1,2,6.9,1.2,1000,16.2,"});
  ASSERT_TRUE(write_charts(order({ladder, times})));
  EXPECT_THAT(text_of(out() / "chart_a.csv"),
              HasSubstr("natural speed,with our network,cpu,6.7,4,2,,,,4.1,"));
  EXPECT_THAT(text_of(out() / "chart_a.svg"), HasSubstr("with our network, 4 ms old  4.0"));
}

TEST_F(ChartsTest, AStressIsTheMeanOverSeedsAndItsBreakdownIsMarked) {
  const auto lines = lines_of(results(), stresses()[0]);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].points[0].y, 3) << "mean of seeds 1 and 2";
  ASSERT_TRUE(lines[0].breakdown);
  EXPECT_DOUBLE_EQ(lines[0].breakdown->x, 15);
  EXPECT_FALSE(lines[1].breakdown);
  ASSERT_TRUE(write_charts(order(all())));
  EXPECT_THAT(text_of(out() / "chart_b_breakdown.csv"), HasSubstr("tracker age,ms,20,15,\n"));
}

TEST_F(ChartsTest, ALevelThatOneMethodLacksIsAnEmptyCellAndTheOthersStayInTheirRows) {
  const auto stress = write_sweep(scratch_.path(), "stress", "twin.tracker.age_ms,interior_mm_mean",
                                  {"paper,5,3,", "paper,10,,", "paper,20,7,", "handcast,10,1.1,",
                                   "handcast,20,1.9,", "handcast,40,2.5,"});
  ASSERT_TRUE(write_charts(order({stress})));
  const std::string harm = ",ms,\"interior error, mean, mm\",";
  EXPECT_THAT(text_of(out() / "chart_b.csv"),
              HasSubstr("tracker age,5" + harm + "3,\ntracker age,10" + harm +
                        ",1.1\ntracker age,20" + harm + "7,1.9\ntracker age,40" + harm + ",2.5\n"));
}

TEST_F(ChartsTest, TheAtlasTellsWhatPassesFromWhatStaysAndWhoNeverRecovers) {
  const auto failures = failures_of(results());
  ASSERT_EQ(failures.size(), 3u);
  EXPECT_EQ(failures[0].name, "tracker silent, 200 ms");
  EXPECT_EQ(failures[0].damage.at("paper").recovery_ms, 73);
  EXPECT_EQ(failures[0].damage.at("handcast").never_good, 1u);
  EXPECT_EQ(failures[1].name, "image dark: 50 % of the light");
  EXPECT_EQ(failures[2].name, "cross fingers");
  ASSERT_TRUE(write_charts(order(all())));
  EXPECT_THAT(
      text_of(out() / "chart_b_faults.csv"),
      HasSubstr("\"tracker silent, 200 ms\",for a moment,handcast,30,not within the run,yes,10"));
}

TEST_F(ChartsTest, TheAtlasSaysWhereThePapersCascadeRecoversFaster) {
  const auto file = write_sweep(
      scratch_.path(), "failures",
      "twin.tracker.frozen_at_s,twin.tracker.frozen_s,twin.detector.lost_at_s,twin.detector.lost_s,"
      "twin.motion,interior_mm_p95,coverage,spill,foldovers,fault_worst_mm,fault_dark_ms,"
      "fault_recovery_ms",
      {"paper,1,0.6,,,builtin:wave,4,0.9,0.1,0,60,20,73,",
       "handcast,1,0.6,,,builtin:wave,3,0.9,0.1,0,30,10,80,",
       "paper,1,0.2,,,builtin:wave,4,0.9,0.1,0,60,20,73,",
       "handcast,1,0.2,,,builtin:wave,3,0.9,0.1,0,30,10,74,",
       "paper,1,0.6,1,0.3,builtin:wave,4,0.9,0.1,0,60,20,,",
       "handcast,1,0.6,1,0.3,builtin:wave,3,0.9,0.1,0,30,10,90,"});
  const auto results = read_results({file});
  ASSERT_TRUE(results) << results.error().what;
  const auto failures = failures_of(*results);
  ASSERT_EQ(failures.size(), 3u);
  EXPECT_EQ(failures[2].name, "landmarks lost, 300 ms + tracker frozen, 600 ms");
  EXPECT_THAT(chart_b_faults(*results).reading,
              HasSubstr("recovers faster than ours in 1 of 3 failures (tracker frozen, 600 ms: 73 "
                        "ms, ours 80 ms)."));
}

TEST_F(ChartsTest, ChartCHasTheRungsByTheirDegreesOfFreedom) {
  ASSERT_TRUE(write_charts(order(all())));
  const auto numbers = text_of(out() / "chart_c.csv");
  EXPECT_THAT(numbers, AllOf(HasSubstr("natural speed,hold,0,7,14,,700\n"),
                             HasSubstr("natural speed,shift,2,3,5,,760\n"),
                             HasSubstr("natural speed,register,55,1,2,,1300\n"),
                             HasSubstr("natural speed,handcast,chosen per frame,1,2.1,,1000\n")));
  EXPECT_THAT(numbers, Not(HasSubstr("paper")));
}

TEST_F(ChartsTest, WhatCannotBeDrawnIsSaidAndTheRestIsDrawn) {
  const auto written = write_charts(order({write_stress(scratch_.path())}));
  ASSERT_TRUE(written) << written.error().what;
  EXPECT_THAT(written->lacking,
              ElementsAre(HasSubstr("chart_a needs"), HasSubstr("chart_b_faults needs"),
                          HasSubstr("chart_c needs")));
  EXPECT_THAT(text_of(written->page), HasSubstr("Not drawn: the chart needs drawn runs"));
  EXPECT_FALSE(fs::exists(out() / "chart_a.svg"));
}

TEST_F(ChartsTest, ResultsWithoutAnyColumnThatIsNeededAreAFault) {
  const auto written =
      write_charts(order({write_sweep(scratch_.path(), "odd", "twin.speed,iou", {"a,1,0.5,"})}));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().what,
              AllOf(HasSubstr("no chart can be drawn"), HasSubstr("interior_mm_p95")));
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(ChartsTest, WithoutGnuplotOneSentenceSaysSoAndNothingIsWritten) {
  auto without = order(all());
  without.gnuplot = "/nowhere/gnuplot";
  const auto written = write_charts(without);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::bad_config);
  EXPECT_THAT(written.error().what,
              AllOf(HasSubstr("/nowhere/gnuplot"), HasSubstr("scripts/setup")));
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(ChartsTest, AGnuplotThatFailsIsQuoted) {
  const auto broken = scratch_.path() / "gnuplot";
  std::ofstream(broken) << "#!/bin/sh\necho 'out of ink' >&2\nexit 1\n";
  fs::permissions(broken, fs::perms::owner_all);
  auto with = order(all());
  with.gnuplot = broken;
  const auto written = write_charts(with);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().what, HasSubstr("out of ink"));
}

TEST_F(ChartsTest, NamesOfMethodsAreNoCommandsOfThePlotter) {
  const auto planted = (scratch_.path() / "planted").string();
  for (const auto& name : {"`touch " + planted + "`", "'; system('touch " + planted + "') #",
                           "\"\"; system('touch " + planted + "') #"}) {
    const auto evil =
        write_sweep(scratch_.path(), "ladder", "twin.speed,motion_to_photon_ms,interior_mm_p95",
                    {"\"" + name + "<b>\",1,7,2,"});
    const auto written = write_charts(order({evil}));
    ASSERT_TRUE(written) << written.error().what;
    EXPECT_FALSE(fs::exists(planted)) << name;
    EXPECT_THAT(text_of(written->page), AllOf(HasSubstr("touch"), Not(HasSubstr("<b>"))));
  }
}

TEST_F(ChartsTest, TheProgramPrintsThePageAndExitsWith100WhereAFileIsNoSweep) {
  const char* bin = std::getenv("HANDCAST_BIN");
  if (!bin) GTEST_SKIP() << "HANDCAST_BIN is not set to the folder of the programs";
  const auto run = [&](const std::string& words) {
    return WEXITSTATUS(
        std::system(fmt::format("{}/handcast-chart {} >/dev/null 2>&1", bin, words).c_str()));
  };
  EXPECT_EQ(run(fmt::format("{} --out {}", write_ladder(scratch_.path()).string(), out().string())),
            0);
  EXPECT_TRUE(fs::exists(out() / "charts.html"));
  EXPECT_EQ(run("CMakeLists.txt"), 100);
}

}  // namespace
}  // namespace handcast::chart
