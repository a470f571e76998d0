// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/course.hpp"

#include <gmock/gmock.h>

#include "services/studies/jnd/subjects.hpp"

namespace handcast::study {
namespace {

/// The log of a simulated subject.
StudyTable log_of(const CourseSettings& settings, int most_trials = 100000) {
  StudyTable log{.name = "log", .columns = Course::columns(), .rows = {}};
  Course course(settings);
  SimulatedSubject subject({3, 6}, settings.seed, settings.subject);
  while (const auto trial = course.trial()) {
    if (std::ssize(log.rows) == most_trials) break;
    const auto answer = subject.answer(*trial);
    log.rows.push_back(course.line(answer, "2026-01-01T00:00:00Z"));
    course.answer(answer);
  }
  return log;
}

TEST(Course, TrainsAndTestsBothConditionsInTheOrderOfALatinSquare) {
  for (const int subject : {1, 2}) {
    Course course({.subject = subject});
    std::vector<Condition> conditions;
    std::vector<bool> training;
    while (const auto trial = course.trial()) {
      if (course.begins_session()) {
        conditions.push_back(trial->condition);
        training.push_back(trial->is_training);
      }
      course.answer({.picks_first = trial->is_late_first != (trial->number % 3 == 2)});
    }
    EXPECT_THAT(training, testing::ElementsAre(true, true, false, false));
    EXPECT_EQ(conditions[0], subject == 1 ? Condition::baseline : Condition::fill);
    EXPECT_NE(conditions[0], conditions[1]);
    EXPECT_EQ(conditions[0], conditions[2]);
    EXPECT_EQ(course.results().size(), 4u);
  }
}

TEST(Course, LateLightIsFirstInHalfOfTheTrials) {
  const auto log = log_of({.subject = 3, .seed = 5, .procedure = ProcedureKind::quest});
  int first = 0;
  for (const auto& row : log.rows) first += row[8] == "1";
  EXPECT_EQ(log.rows.size(), 240u);
  EXPECT_NEAR(first, 120, 25);
}

TEST(Course, ACourseThatWasCutOffGoesOnTrialByTrial) {
  for (const auto kind :
       {ProcedureKind::staircase, ProcedureKind::interleaved, ProcedureKind::quest}) {
    const CourseSettings settings{.subject = 4, .seed = 11, .procedure = kind};
    const auto whole = log_of(settings), part = log_of(settings, 50);
    Course course(settings);
    ASSERT_TRUE(course.replay(part));
    for (std::size_t row = 50; row < whole.rows.size(); ++row) {
      const Answer answer{.picks_first = whole.rows[row][10] == "1"};
      ASSERT_EQ(course.line(answer, "2026-01-01T00:00:00Z"), whole.rows[row]);
      course.answer(answer);
    }
    EXPECT_FALSE(course.trial());
  }
}

TEST(Course, ALogThatWasChangedOrIsOfAnotherSeedIsRefused) {
  const CourseSettings settings{.subject = 1, .seed = 2};
  auto log = log_of(settings);
  EXPECT_TRUE(Course(settings).replay(log));
  EXPECT_FALSE(Course({.subject = 1, .seed = 3}).replay(log));
  auto other = settings;
  other.stimulus = "another motion";
  EXPECT_FALSE(Course(other).replay(log));
  log.rows[7][10] = log.rows[7][10] == "1" ? "2" : "1";  // another answer: other delays follow
  const auto refused = Course(settings).replay(log);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("row 9 does not follow"));
  log = log_of(settings);
  log.rows.push_back(log.rows.back());
  EXPECT_FALSE(Course(settings).replay(log));
}

}  // namespace
}  // namespace handcast::study
