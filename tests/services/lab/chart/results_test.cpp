// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/results.hpp"

#include <gmock/gmock.h>

#include "tests/scratch.hpp"
#include "tests/services/lab/chart/sweeps.hpp"

namespace handcast::chart {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ResultsTest : public testing::Test {
 protected:
  std::string fault_of(const std::string& text) {
    const auto file = scratch_.path() / "results.csv";
    std::ofstream(file, std::ios::binary) << text;
    const auto results = read_results({file});
    return results ? "" : results.error().what;
  }

  test::Scratch scratch_;
};

TEST_F(ResultsTest, ARunHasTheSettingsOfItsGridAndTheMetricsThatWereMeasured) {
  const auto results =
      read_results({write_stress(scratch_.path()), write_failures(scratch_.path())});
  ASSERT_TRUE(results) << results.error().what;
  ASSERT_EQ(results->runs.size(), 11u);
  const auto& run = results->runs[8];
  EXPECT_EQ(run.variant, "handcast");
  EXPECT_EQ(run.plan, "failures");
  EXPECT_EQ(run.metric("fault_worst_mm"), 30);
  EXPECT_FALSE(run.metric("fault_recovery_ms")) << "the run has no recovery";
  EXPECT_THAT(run.turned(), ElementsAre("twin.tracker.lost_at_s", "twin.tracker.lost_s"));
  EXPECT_THAT(results->runs[9].turned(), ElementsAre("twin.image.dark"))
      << "empty cells are not axes";
}

TEST_F(ResultsTest, AMeanIsOfTheRunsThatHaveTheFigure) {
  const auto results = read_results({write_failures(scratch_.path())});
  ASSERT_TRUE(results);
  const auto all = results->select([](const auto&) { return true; });
  EXPECT_DOUBLE_EQ(*mean_of(all, "fault_worst_mm"), 45);
  EXPECT_FALSE(mean_of(all, "nonsense"));
}

TEST_F(ResultsTest, FailedRunsAreLeftOutAndCounted) {
  const auto file = write_sweep(scratch_.path(), "some", "twin.speed,interior_mm_p95",
                                {"a,1,2,", "a,2,,\"it broke, twice\""});
  const auto results = read_results({file});
  ASSERT_TRUE(results) << results.error().what;
  EXPECT_EQ(results->runs.size(), 1u);
  EXPECT_EQ(results->sources[0].failed, 1u);
}

TEST_F(ResultsTest, ASettingOfNoSectionIsASettingToo) {
  const auto results =
      read_results({write_sweep(scratch_.path(), "some", "calibration,iou", {"a,ours.toml,0.9,"})});
  ASSERT_TRUE(results) << results.error().what;
  EXPECT_THAT(results->runs[0].turned(), ElementsAre("calibration"));
}

TEST_F(ResultsTest, WhatIsNoSweepIsToldInASentence) {
  EXPECT_THAT(fault_of(""), HasSubstr("results.csv: the file does not hold results of a sweep"));
  EXPECT_THAT(fault_of("a,b\n1,2\n"),
              HasSubstr("results.csv: the file does not hold results of a sweep"));
  EXPECT_THAT(fault_of("# handcast sweep version=1 runs=1 plan=x\na,b,c\n"),
              HasSubstr("results.csv: the file does not hold results of a sweep"));
  EXPECT_THAT(fault_of("# handcast sweep version=1 runs=1 plan=x\nindex,variant,iou,error\n"),
              HasSubstr("results.csv: the file has no scored run"));
  EXPECT_THAT(fault_of("# handcast sweep version=1 runs=1 plan=x\nindex,variant,iou,error\n0,a\n"),
              HasSubstr("results.csv:3: the line is not one of this sweep"));
  EXPECT_THAT(
      fault_of("# handcast sweep version=1 runs=1 plan=x\nindex,variant,iou,error\n0,a,much,\n"),
      HasSubstr("results.csv: run 0: iou is 'much', which is not a number"));
  const auto absent = read_results({scratch_.path() / "nowhere.csv"});
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().what, HasSubstr("nowhere.csv"));
}

}  // namespace
}  // namespace handcast::chart
