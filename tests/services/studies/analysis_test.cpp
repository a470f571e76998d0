// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/analysis.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "services/studies/jnd/subjects.hpp"
#include "tests/scratch.hpp"
#include "tests/services/studies/papers_subjects.hpp"

namespace handcast::study {
namespace {

using testing::HasSubstr;

class Analysis : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    const auto file = scratch_.path() / name;
    std::ofstream(file) << text;
    return file.string();
  }
  /// The log of a simulated subject.
  void write_log(int number, int most_trials = 100000, const char* stimulus = "film") const {
    const CourseSettings settings{.subject = number, .seed = 9, .stimulus = stimulus};
    Course course(settings);
    SimulatedSubject subject({3, 6}, settings.seed, number);
    std::string text = print_csv(Course::columns());
    for (int trials = 0; trials < most_trials; ++trials) {
      const auto trial = course.trial();
      if (!trial) break;
      const auto answer = subject.answer(*trial);
      text += print_csv(course.line(answer, "now"));
      course.answer(answer);
    }
    write(fmt::format("subject-{:02}.csv", number), text);
  }
  test::Scratch scratch_;
};

TEST_F(Analysis, ATableOfThePapersSubjectsGivesItsFigures) {
  std::string text = "subject,condition,jnd_ms\n";
  for (std::size_t s = 0; s < kPapersBaseline.size(); ++s)
    text +=
        fmt::format("{0},baseline,{1}\n{0},fill,{2}\n", s + 1, kPapersBaseline[s], kPapersFill[s]);
  const auto findings = analyse({write("paper.csv", text)});
  ASSERT_TRUE(findings) << findings.error().what;
  const auto json = to_json(*findings);
  EXPECT_NEAR(json["conditions"]["baseline"]["mean_ms"].get<double>(), 3.08, 0.005);
  EXPECT_NEAR(json["conditions"]["fill"]["sd_ms"].get<double>(), 4.54, 0.005);
  EXPECT_NEAR(json["paired_t_test"]["t"].get<double>(), 2.35, 0.005);
  EXPECT_EQ(json["paired_t_test"]["df"], 9);
  EXPECT_LT(json["paired_t_test"]["p"].get<double>(), 0.05);
  EXPECT_THAT(page_of(*findings, ""), HasSubstr("t(9) = 2.35"));
}

TEST_F(Analysis, AFolderOfLogsGivesTheTestSessionsAndNamesTheUnfinished) {
  write_log(1);
  write_log(2);
  write_log(3, 30);
  write("subject-01.light.csv", "session\n");
  const auto findings = analyse({scratch_.path().string()});
  ASSERT_TRUE(findings) << findings.error().what;
  EXPECT_THAT(findings->comparison.subjects, testing::ElementsAre("1", "2"));
  ASSERT_EQ(findings->unfinished.size(), 1u);
  EXPECT_THAT(findings->unfinished[0], HasSubstr("subject-03.csv"));
  for (std::size_t s = 0; s < 2; ++s) {
    const auto& session = findings->sessions[4 * s + 2];
    EXPECT_FALSE(session.result.is_training);
    const auto condition = static_cast<std::size_t>(session.result.condition);
    EXPECT_DOUBLE_EQ(findings->comparison.values[condition][s], session.result.jnd_ms);
  }
}

TEST_F(Analysis, LogsOfDifferentStimuliAreNotPooled) {
  write_log(1);
  write_log(2, 100000, "a faster film");
  EXPECT_THAT(analyse({scratch_.path().string()}).error().what, HasSubstr("analyse them apart"));
}

TEST_F(Analysis, AnEnormousValueMakesAPageOfUsualSize) {
  const auto findings = analyse(
      {write("huge.csv",
             "subject,condition,jnd_ms\n1,baseline,1e300\n1,fill,-4\n2,baseline,3\n2,fill,4\n")});
  ASSERT_TRUE(findings) << findings.error().what;
  EXPECT_LT(page_of(*findings, "").size(), 20'000u);
}

TEST_F(Analysis, WhatIsNoStudyIsRefusedWithASentence) {
  EXPECT_THAT(analyse({write("a.csv", "a,b\n1,2\n")}).error().what,
              HasSubstr("no column 'subject'"));
  EXPECT_THAT(analyse({write("b.csv", "subject,condition,jnd_ms\n1,fill,x\n")}).error().what,
              HasSubstr("row 1: jnd_ms is 'x'"));
  EXPECT_THAT(analyse({scratch_.path().string()}).error().what,
              HasSubstr("there are no logs (subject-NN.csv)"));
  EXPECT_THAT(analyse({"/nowhere.csv"}).error().what, HasSubstr("/nowhere.csv"));
  const auto header = print_csv(Course::columns());
  EXPECT_THAT(
      analyse({write("c.csv", header + "1,1,stairs,1,training,baseline,1,20,1,film,1,1,0,0,0,x\n")})
          .error()
          .what,
      HasSubstr("protocol 'stairs'"));
  EXPECT_THAT(analyse({write("d.csv", header)}).error().what, HasSubstr("no trial was answered"));
}

TEST(SimulatedSubjects, TheOrderOfThePaperComesOutAndBiasesAreReported) {
  const auto json = simulate_subjects({3.08, 6.62}, 60, 4);
  EXPECT_LT(json["comparison"]["conditions"]["baseline"]["mean_ms"],
            json["comparison"]["conditions"]["fill"]["mean_ms"]);
  EXPECT_LT(json["comparison"]["paired_t_test"]["p"].get<double>(), 0.05);
  const auto& quest = json["procedures"]["quest"]["estimates"]["baseline"]["fit"];
  EXPECT_LT(std::abs(quest["bias_ms"].get<double>()), 0.6);
  EXPECT_EQ(quest["trials"], 60);
  EXPECT_EQ(json, simulate_subjects({3.08, 6.62}, 60, 4));
}

}  // namespace
}  // namespace handcast::study
