// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/results.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/services/lab/sweep/plans.hpp"

namespace handcast::sweep {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A plan of six runs and a folder for their results.
class ResultsTest : public testing::Test {
 protected:
  Row row(std::size_t index, double error_mm, double machine = 900) const {
    return scored_row(plan_, expansion_.runs[index],
                      {{"landmark_mm", {{"mean", error_mm}, {"p95", nullptr}}},
                       {"frame_us", {{"p50", machine}}},
                       {"stage_us", {{"predict", {{"p50", machine}}}}},
                       {"detector", {{"ms_p50", machine}}}});
  }
  Row broken(std::size_t index) const {
    return failed_row(plan_, expansion_.runs[index], "hand 'x, \"y\".glb':\nno such file");
  }

  std::filesystem::path file(const std::string& name) const { return scratch_.path() / name; }

  std::filesystem::path written(const std::string& name, const std::vector<Row>& rows) const {
    auto results = Results::open(file(name), heading_, false);
    EXPECT_TRUE(results) << results.error().what;
    for (const auto& each : rows) EXPECT_TRUE((*results)->append(each));
    EXPECT_TRUE((*results)->sort());
    return file(name);
  }

  test::Scratch scratch_;
  Plan plan_ = *plan_of("[grid]\ntwin.speed = [1, 2]\ntwin.seed = [1, 2, 3]\n");
  Expansion expansion_ = *expand(plan_);
  Heading heading_ = heading_of(plan_, expansion_, "1.0");
};

TEST_F(ResultsTest, AFileBeginsWithWhatItIsOf) {
  const auto text = text_of(written("a.csv", {row(4, 1.5)}));
  EXPECT_THAT(
      text, StartsWith("# handcast sweep version=1.0 fingerprint=" + expansion_.fingerprint +
                       " runs=6 plan=test\nindex,variant,twin.speed,twin.seed,interior_mm_mean,"));
  EXPECT_THAT(text, HasSubstr("\n4,twin,2,2,,,,,1.5,,"));
}

TEST_F(ResultsTest, ARowReadsBackAsItWasWritten) {
  const Row row{"3", "a, b", "say \"no\"", "", "1.5"};
  const auto line = print_csv(row);
  EXPECT_EQ(parse_csv(std::string_view(line).substr(0, line.size() - 1)), row);
}

TEST_F(ResultsTest, LinesAreInTheOrderOfTheRunsOnceItIsDone) {
  const auto table = read_table(written("a.csv", {row(4, 1), row(0, 1), row(2, 1)}));
  ASSERT_TRUE(table);
  ASSERT_EQ(table->rows.size(), 3u);
  EXPECT_EQ(table->rows[0][0], "0");
  EXPECT_EQ(table->rows[2][0], "4");
}

TEST_F(ResultsTest, GoesOnWithoutATornLastLine) {
  const auto path = written("a.csv", {row(0, 1), row(1, 1), row(2, 1)});
  const auto whole = text_of(path);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 3);
  auto results = Results::open(path, heading_, false);
  ASSERT_TRUE(results) << results.error().what;
  EXPECT_THAT((*results)->done(), ElementsAre(0u, 1u));
  ASSERT_TRUE((*results)->append(row(2, 1)));
  EXPECT_EQ(text_of(path), whole);
}

TEST_F(ResultsTest, GoesOnWhereverItWasCutOff) {
  const auto path = written("a.csv", {row(0, 1), row(1, 1)});
  const auto whole = text_of(path);
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    write_text(path, whole.substr(0, cut));
    auto results = Results::open(path, heading_, false);
    ASSERT_TRUE(results) << cut << ": " << results.error().what;
    for (const std::size_t index : {0, 1}) {
      if ((*results)->done().contains(index)) continue;
      ASSERT_TRUE((*results)->append(row(index, 1)));
    }
    ASSERT_EQ(text_of(path), whole) << cut;
  }
}

TEST_F(ResultsTest, ARunThatFailedIsDoneAgainAndItsLineReplaced) {
  const auto path = written("a.csv", {row(0, 1), broken(1)});
  EXPECT_THAT(text_of(path), HasSubstr("\"hand 'x, \"\"y\"\".glb': no such file\"\n"));
  {
    auto results = Results::open(path, heading_, false);
    ASSERT_TRUE(results) << results.error().what;
    EXPECT_THAT((*results)->done(), ElementsAre(0u));
    ASSERT_TRUE((*results)->append(row(1, 2)));
    ASSERT_TRUE((*results)->sort());
  }
  EXPECT_THAT(read_table(path)->rows, ElementsAre(row(0, 1), row(1, 2)));
}

TEST_F(ResultsTest, AnotherPlansFileIsLeftAlone) {
  const auto path = written("a.csv", {row(0, 1)});
  const auto before = text_of(path);
  auto other = expansion_;
  other.fingerprint = "0123456789abcdef";
  const auto refused = Results::open(path, heading_of(plan_, other, "1.0"), false);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("another plan"));
  EXPECT_FALSE(Results::open(path, heading_of(plan_, expansion_, "2.0"), false))
      << "another version gives other figures";
  EXPECT_EQ(text_of(path), before);
  EXPECT_TRUE(Results::open(path, heading_of(plan_, other, "1.0"), true)) << "--fresh";
}

TEST_F(ResultsTest, AFileOfAnEarlierBuildIsKnownHoweverOftenItIsOpened) {
  const auto path = written("a.csv", {row(0, 1)});
  EXPECT_FALSE((*Results::open(path, heading_, false))->is_of_an_earlier_build());
  std::filesystem::last_write_time(
      path, std::filesystem::last_write_time("/proc/self/exe") - std::chrono::seconds(1));
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE((*Results::open(path, heading_, false))->is_of_an_earlier_build());
  EXPECT_FALSE((*Results::open(path, heading_, true))->is_of_an_earlier_build()) << "--fresh";
}

TEST_F(ResultsTest, AFileThatIsNoneOfASweepIsLeftAlone) {
  for (const std::string text : {"one line without an end", "my,precious\n1,2\n"}) {
    write_text(file("notes.csv"), text);
    EXPECT_FALSE(Results::open(file("notes.csv"), heading_, false));
    EXPECT_EQ(text_of(file("notes.csv")), text);
  }
}

TEST_F(ResultsTest, TwoSweepsDoNotWriteOneFile) {
  const auto first = Results::open(file("a.csv"), heading_, false);
  ASSERT_TRUE(first);
  const auto second = Results::open(file("a.csv"), heading_, false);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::unavailable);
}

TEST_F(ResultsTest, ShardsMergeToTheFileOneMachineWouldHaveWritten) {
  const auto whole =
      written("whole.csv", {row(0, 1), row(1, 2), row(2, 3), row(3, 4), row(4, 5), row(5, 6)});
  const auto even = written("even.csv", {row(4, 5), row(0, 1), row(2, 3)});
  const auto odd = written("odd.csv", {row(1, 2), row(3, 4), row(5, 6)});
  const auto merged = merge({odd, even}, file("merged.csv"));
  ASSERT_TRUE(merged) << merged.error().what;
  EXPECT_EQ(merged->rows, 6u);
  EXPECT_TRUE(merged->missing.empty());
  EXPECT_EQ(text_of(file("merged.csv")), text_of(whole));
}

TEST_F(ResultsTest, MergingNamesTheRunsThatAreMissing) {
  const auto merged = merge({written("a.csv", {row(1, 1)})}, file("merged.csv"));
  ASSERT_TRUE(merged);
  EXPECT_EQ(print_indices(merged->missing), "0, 2-5");
}

TEST_F(ResultsTest, DuplicatesMustAgreeButForTheTimesARealDetectorsAmongThem) {
  const auto a = written("a.csv", {row(0, 1, 900), row(1, 1)});
  EXPECT_TRUE(merge({a, written("b.csv", {row(0, 1, 1234)})}, file("merged.csv")));
  const auto refused = merge({a, written("c.csv", {row(0, 1.0001)})}, file("merged.csv"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("disagree on landmark_mm_mean"));
}

TEST_F(ResultsTest, AShardInWhichTheRunSucceededCounts) {
  const auto bad = written("bad.csv", {broken(0)}), good = written("good.csv", {row(0, 1)});
  for (const auto& order : {std::vector{bad, good}, std::vector{good, bad}}) {
    const auto merged = merge(order, file("merged.csv"));
    ASSERT_TRUE(merged) << merged.error().what;
    EXPECT_EQ(merged->failed, 0u);
    EXPECT_THAT(read_table(file("merged.csv"))->rows, ElementsAre(row(0, 1)));
  }
}

TEST_F(ResultsTest, AnEmptyFileIsATableOfNothing) {
  write_text(file("empty.csv"), "");
  const auto table = read_table(file("empty.csv"));
  ASSERT_TRUE(table) << table.error().what;
  EXPECT_TRUE(table->rows.empty());
}

TEST_F(ResultsTest, AFileWithoutAHeadingIsNotMerged) {
  const auto refusal = [&](const std::string& text) {
    write_text(file("odd.csv"), text);
    const auto merged = merge({file("odd.csv")}, file("merged.csv"));
    return merged ? "(it was merged)" : merged.error().what;
  };
  EXPECT_THAT(refusal(""), HasSubstr("odd.csv: the file has no heading"));
  EXPECT_THAT(refusal("# handcast sweep version=1 runs=6 plan=x"), HasSubstr("no heading"));
  EXPECT_THAT(refusal("# handcast sweep version=1 runs=6 plan=x\n"), HasSubstr("no heading"));
  EXPECT_THAT(refusal("# handcast sweep runs=99999999999999\nindex,variant\n"),
              HasSubstr("does not hold results"));
}

TEST_F(ResultsTest, FilesOfTwoPlansAreNotMerged) {
  const auto mine = written("a.csv", {row(0, 1)});
  heading_.stamp += "x";
  const auto other = written("b.csv", {row(1, 1)});
  const auto refused = merge({mine, other}, file("merged.csv"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("different plans"));
}

TEST_F(ResultsTest, FreshDiscardsResultsAndNothingElse) {
  written("old.csv", {row(1, 1)});
  ASSERT_TRUE(Results::open(file("old.csv"), heading_, true));
  EXPECT_TRUE(read_table(file("old.csv"))->rows.empty());
  std::ofstream(file("notes.txt")) << "my notes";
  const auto refused = Results::open(file("notes.txt"), heading_, true);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("is left as it is"));
  EXPECT_EQ(text_of(file("notes.txt")), "my notes");
}

TEST_F(ResultsTest, AFileThatIsReplacedDuringTheSweepIsSaid) {
  auto results = Results::open(file("a.csv"), heading_, false);
  ASSERT_TRUE((*results)->append(row(0, 1)));
  std::filesystem::rename(file("a.csv"), file("b.csv"));
  std::ofstream(file("a.csv")) << "another";
  for (const auto& done : {(*results)->append(row(1, 1)), (*results)->sort()}) {
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, Errc::unavailable);
    EXPECT_THAT(done.error().what, HasSubstr("replaced the file"));
  }
  EXPECT_EQ(text_of(file("a.csv")), "another");
}

TEST_F(ResultsTest, AMergeLosesNoRunOfTheFileThatItReplaces) {
  const auto fuller = written("all.csv", {row(0, 1), row(3, 1), row(4, 1)});
  const auto before = text_of(fuller);
  const auto shard = written("shard.csv", {row(0, 1)});
  const auto refused = merge({shard}, fuller);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("no merged file has (3-4)"));
  std::ofstream(file("notes.txt")) << "my notes";
  EXPECT_FALSE(merge({shard}, file("notes.txt")));
  EXPECT_EQ(text_of(fuller), before);
  EXPECT_EQ(text_of(file("notes.txt")), "my notes");
  EXPECT_TRUE(merge({shard, fuller}, fuller));
  for (const std::size_t bytes : {std::size_t{10}, heading_.stamp.size() + 20}) {
    std::ofstream(file("cut.csv")) << heading_.print().substr(0, bytes);
    EXPECT_TRUE(merge({shard}, file("cut.csv"))) << "it holds no run";
    std::filesystem::remove(file("cut.csv"));
  }
}

TEST_F(ResultsTest, AFileThatASweepWritesIsNotMergedInto) {
  const auto shard = written("shard.csv", {row(0, 1)});
  const auto sweep = Results::open(file("all.csv"), heading_, false);
  const auto refused = merge({shard}, file("all.csv"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("another sweep is writing"));
}

}  // namespace
}  // namespace handcast::sweep
