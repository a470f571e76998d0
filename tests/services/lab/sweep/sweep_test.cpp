// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "services/lab/simulate/score.hpp"
#include "services/lab/sweep/results.hpp"
#include "services/lab/sweep/runner.hpp"
#include "tests/services/lab/sweep/plans.hpp"

namespace handcast::sweep {
namespace {

using testing::HasSubstr;

constexpr const char* kTiny = R"(
joints_only = true
seconds = 0.2
warm_up_s = 0.05
[settings]
landmarks.backend = "twin"
[grid]
cascade.filter.method = ["paper", "kalman"]
twin.seed = [1, 2, 3]
)";

class SweepTest : public testing::Test {
 protected:
  Outcome sweep(const std::string& toml, const std::string& name, int jobs = 1, Shard shard = {},
                bool stopped = false, const std::string& record = "") {
    const auto plan = plan_of(toml);
    EXPECT_TRUE(plan) << plan.error().what;
    const auto expansion = expand(*plan);
    auto results = Results::open(file(name), heading_of(*plan, *expansion, "1.0"), false);
    EXPECT_TRUE(results) << results.error().what;
    const std::atomic<bool> stop = stopped;
    const auto outcome =
        run_all(*plan, expansion->runs, {shard, jobs, true, record}, **results, stop);
    EXPECT_TRUE(outcome) << outcome.error().what;
    return *outcome;
  }
  std::filesystem::path file(const std::string& name) const { return scratch_.path() / name; }

  test::Scratch scratch_;
};

/// A variant with the results in a folder.
std::string row_of(const std::string& name, const std::filesystem::path& folder) {
  return fmt::format("[[variant]]\nname = \"{}\"\nlandmarks = \"{}\"\n", name, folder.string());
}

TEST_F(SweepTest, TheResultsOfAMethodAreScoredInTheirCases) {
  const std::string cases =
      "joints_only = true\nseconds = 0.2\nwarm_up_s = 0.05\n[settings]\n"
      "landmarks.backend = \"twin\"\n[grid]\ntwin.seed = [1, 2]\n";
  const auto plan = cases + "[[variant]]\nname = \"own\"\n" +
                    row_of("landmarks", file("landmarks")) + row_of("true", file("true_landmarks"));
  EXPECT_EQ(sweep(cases, "recorded.csv", 1, {}, false, file("cases")).scored, 2u);
  for (const std::string table : {"landmarks", "true_landmarks"}) {
    std::filesystem::create_directory(file(table));
    for (const std::string number : {"000", "001"})
      std::filesystem::copy(file("cases") / number / (table + ".csv"),
                            file(table) / (number + ".csv"));
  }
  ASSERT_EQ(sweep(plan, "scored.csv").scored, 6u);
  const auto table = read_table(file("scored.csv"));
  const auto column = std::ranges::find(table->heading.columns, "landmark_mm_mean") -
                      table->heading.columns.begin();
  const auto error_mm = [&](std::size_t run) { return std::stod(table->rows[run][column]); };
  for (const std::size_t seed : {0u, 1u}) {
    EXPECT_EQ(error_mm(seed), error_mm(2 + seed)) << "what its own detector has found";
    EXPECT_LT(error_mm(4 + seed), error_mm(seed)) << "the truth";
  }
  std::filesystem::remove(file("true_landmarks/001.csv"));
  EXPECT_EQ(sweep(plan, "part.csv").absent, 1u);
}

TEST_F(SweepTest, TheNumberOfThreadsDoesNotChangeTheFile) {
  EXPECT_EQ(sweep(kTiny, "one.csv", 1).scored, 6u);
  EXPECT_EQ(sweep(kTiny, "three.csv", 3).scored, 6u);
  EXPECT_EQ(text_of(file("one.csv")), text_of(file("three.csv")));
  const auto table = read_table(file("one.csv"));
  const auto column = std::ranges::find(table->heading.columns, "landmark_mm_mean") -
                      table->heading.columns.begin();
  EXPECT_NE(table->rows[0][column], "");
  EXPECT_NE(table->rows[0][column], table->rows[1][column]) << "another seed, another error";
}

TEST_F(SweepTest, ShardsMergeToTheFileOfAWholeRun) {
  sweep(kTiny, "whole.csv");
  sweep(kTiny, "a.csv", 2, {0, 2});
  sweep(kTiny, "b.csv", 2, {1, 2});
  ASSERT_TRUE(merge({file("b.csv"), file("a.csv")}, file("merged.csv")));
  EXPECT_EQ(text_of(file("merged.csv")), text_of(file("whole.csv")));
}

TEST_F(SweepTest, DoesNotGoOnWithRunsOfAnEarlierBuild) {
  const auto plan = plan_of(kTiny);
  ASSERT_TRUE(plan);
  const auto expansion = expand(*plan);
  ASSERT_TRUE(expansion);
  const auto go_on = [&] {
    std::filesystem::last_write_time(
        file("a.csv"),
        std::filesystem::last_write_time("/proc/self/exe") - std::chrono::seconds(1));
    const auto results = Results::open(file("a.csv"), heading_of(*plan, *expansion, "1.0"), false);
    EXPECT_TRUE(results) << results.error().what;
    const std::atomic<bool> stop{false};
    return run_all(*plan, expansion->runs, {{}, 1, true}, **results, stop);
  };
  sweep(kTiny, "a.csv");
  EXPECT_TRUE(go_on()) << "no run is left";
  const auto whole = text_of(file("a.csv"));
  std::filesystem::resize_file(file("a.csv"), whole.size() - 10);
  const auto refused = go_on();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("an earlier build"));
}

TEST_F(SweepTest, GoesOnWhereItWasCutOff) {
  sweep(kTiny, "a.csv");
  const auto whole = text_of(file("a.csv"));
  std::filesystem::resize_file(file("a.csv"), whole.size() - 10);
  const auto outcome = sweep(kTiny, "a.csv");
  EXPECT_EQ(outcome.kept, 5u);
  EXPECT_EQ(outcome.scored, 1u);
  EXPECT_EQ(text_of(file("a.csv")), whole);
}

TEST_F(SweepTest, StoppedItBeginsNothing) {
  const auto outcome = sweep(kTiny, "a.csv", 2, {}, true);
  EXPECT_EQ(outcome.left, 6u);
  EXPECT_EQ(outcome.scored, 0u);
}

TEST_F(SweepTest, ARunThatCannotBeDoneIsALineAndTheOthersGoOn) {
  const auto outcome = sweep(
      "joints_only = true\nseconds = 0.1\n[grid]\nhand.left = [\"nowhere.glb\", \"\"]\n", "a.csv");
  EXPECT_EQ(outcome.failed, 1u);
  EXPECT_EQ(outcome.scored, 1u);
  const auto table = read_table(file("a.csv"));
  ASSERT_EQ(table->rows.size(), 2u);
  EXPECT_THAT(table->rows[0].back(), HasSubstr("nowhere.glb"));
  EXPECT_EQ(table->rows[1].back(), "");
}

/// A motion that is a link to itself: the query of its type throws.
TEST_F(SweepTest, ARunThatThrowsIsALineAndTheOthersGoOn) {
  const auto motion = file("motion");
  std::filesystem::create_symlink("motion", motion);
  const auto outcome = sweep("joints_only = true\nseconds = 0.1\n[grid]\ntwin.motion = [\"" +
                                 motion.string() + "\", \"builtin:wave\"]\n",
                             "a.csv");
  EXPECT_EQ(outcome.failed, 1u);
  EXPECT_EQ(outcome.scored, 1u);
  EXPECT_THAT(read_table(file("a.csv"))->rows[0].back(), HasSubstr(motion.string()));
}

TEST_F(SweepTest, ARunWithoutAHandHasFailed) {
  const auto outcome = sweep(
      "joints_only = true\nseconds = 0.1\nsettings.twin.hands = \"right\"\n[grid]\ntwin.motion = "
      "[\"builtin:still\"]\n",
      "a.csv");
  EXPECT_EQ(outcome.failed, 1u);
  EXPECT_THAT(read_table(file("a.csv"))->rows[0].back(), HasSubstr("there is nothing to score"));
}

TEST_F(SweepTest, ARunWithoutLightIsScoredAndReported) {
  testing::internal::CaptureStderr();
  const auto outcome = sweep(
      "seconds = 0.1\nsettings.landmarks.backend = \"twin\"\nsettings.twin.tracker.dropout = 1\n"
      "[grid]\ntwin.motion = [\"builtin:still\"]\n",
      "a.csv");
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("run 0 (twin, twin.motion=builtin:still): scored, but no light was on a "
                        "hand in any frame"));
  EXPECT_EQ(outcome.scored, 1u);
}

TEST_F(SweepTest, AMotionThatIsNotThereIsLeftOut) {
  testing::internal::CaptureStderr();
  const auto outcome = sweep(
      "joints_only = true\nseconds = 0.1\n[grid]\ntwin.motion = [\"nowhere\", \"builtin:wave\"]\n",
      "a.csv");
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("there is no folder /plans/nowhere; left out: runs 0"));
  EXPECT_EQ(outcome.absent, 1u);
  EXPECT_EQ(outcome.scored, 1u);
}

TEST_F(SweepTest, AsManyFramesASecondAreScoredOfEachProjector) {
  const auto plan = [](const char* drawn, int rate_hz) {
    return fmt::format(
        "{}\nseconds = 0.2\nwarm_up_s = 0.05\n[settings]\nlandmarks.backend = \"twin\"\n"
        "[grid]\nprojector.rate_hz = [{}]\n",
        drawn, rate_hz);
  };
  const auto figures = [&](const std::string& toml) {
    sweep(toml, "a.csv");
    const auto table = read_table(file("a.csv"));
    std::filesystem::remove(file("a.csv"));
    Row row;
    for (std::size_t i = 0; i < table->heading.columns.size(); ++i)
      if (!is_machine_time(table->heading.columns[i])) row.push_back(table->rows[0][i]);
    return row;
  };
  EXPECT_EQ(figures(plan("draw_hz = 30", 240)), figures(plan("draw_every = 8", 240)));
  EXPECT_EQ(figures(plan("draw_hz = 30", 60)), figures(plan("draw_every = 2", 60)));
  EXPECT_EQ(figures(plan("draw_hz = 30", 10)), figures(plan("draw_every = 1", 10)));
}

/// Compares all metrics of drawn frames bit by bit, except for the times.
TEST_F(SweepTest, ARunBesideOthersGivesTheFiguresOfARunAlone) {
  const auto plan = plan_of("[settings]\ntwin.speed = 3\n[grid]\ntwin.seed = [1, 2]\n");
  ASSERT_TRUE(plan);
  const auto runs = expand(*plan)->runs;
  simulate::Options options;
  options.seconds = 0.2;
  options.warm_up_s = 0.05;
  options.draw_every = 48;
  const auto figures = [&](std::size_t index) {
    const auto rig = rig_of(*plan, runs[index]);
    auto json = simulate::score(*rig, *calib::load_calibration(rig->calibration), options);
    EXPECT_TRUE(json) << json.error().what;
    json->erase("frame_us");
    json->erase("stage_us");
    (*json)["detector"].erase("ms_p50");
    return json->dump();
  };
  const auto alone = figures(0);
  std::array<std::string, 3> together;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < together.size(); ++i)
      threads.emplace_back([&, i] { together[i] = figures(i % 2); });
  }
  EXPECT_EQ(together[0], alone);
  EXPECT_EQ(together[2], alone);
  EXPECT_NE(together[1], alone);
}

/// Runs the program.
class SweepProgramTest : public SweepTest {
 protected:
  int handcast(const std::string& arguments) {
    const char* bin = std::getenv("HANDCAST_BIN");
    const auto command = std::string(bin ? bin : "bin") + "/handcast-sweep " + arguments + " >" +
                         file("said").string() + " 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }
  std::string said() const { return text_of(file("said")); }
};

TEST_F(SweepProgramTest, SweepsInShardsAndMerges) {
  const auto plan = file("tiny.toml").string(), folder = scratch_.path().string();
  write_text(plan, default_rig() + kTiny);
  for (const std::string shard : {"0/2", "1/2"})
    ASSERT_EQ(
        handcast(plan + " --shard " + shard + " -o " + folder + "/" + shard.substr(0, 1) + ".csv"),
        0)
        << said();
  ASSERT_EQ(handcast("--merge " + folder + "/0.csv " + folder + "/1.csv -o " + folder + "/all.csv"),
            0)
      << said();
  EXPECT_EQ(read_table(file("all.csv"))->rows.size(), 6u);
  EXPECT_EQ(handcast("--merge " + folder + "/0.csv -o " + folder + "/half.csv"), 1);
  EXPECT_THAT(said(), HasSubstr("no file has runs 1, 3, 5"));
  EXPECT_EQ(handcast(plan + " -o " + folder + "/all.csv"), 0);
  EXPECT_THAT(said(), HasSubstr("0 runs scored, 0 failed, 6 kept"));
}

TEST_F(SweepProgramTest, ListsAndRunsNothing) {
  write_text(file("tiny.toml"), default_rig() + kTiny);
  ASSERT_EQ(handcast(file("tiny.toml").string() + " --list --shard 1/4"), 0);
  EXPECT_EQ(said(),
            "     1  twin, cascade.filter.method=paper, twin.seed=2\n     5  twin, "
            "cascade.filter.method=kalman, twin.seed=3\n");
}

TEST_F(SweepProgramTest, ExitsWith1WhereARunFailedAndWith100WhereThePlanIsWrong) {
  write_text(file("plan.toml"),
             default_rig() +
                 "joints_only = true\nseconds = 0.1\n[settings]\nhand.left = \"nowhere.glb\"\n");
  EXPECT_EQ(handcast(file("plan.toml").string() + " -o " + file("a.csv").string()), 1);
  write_text(file("plan.toml"), default_rig() + "secods = 1\n");
  EXPECT_EQ(handcast(file("plan.toml").string() + " -o " + file("a.csv").string()), 100);
  EXPECT_THAT(said(),
              HasSubstr("plan.toml:2: secods: there is no such setting (did you mean 'seconds'?)"));
}

}  // namespace
}  // namespace handcast::sweep
