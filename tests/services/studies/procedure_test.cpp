// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/procedure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "services/lab/twin/random.hpp"
#include "services/studies/jnd/psychometric.hpp"

namespace handcast::study {
namespace {

TEST(Staircase, StepsAreOneDownAndThreeUpAndHalvedAtReversals) {
  Staircase stairs({});
  EXPECT_DOUBLE_EQ(stairs.next_ms(), 20);
  stairs.answer(true);
  EXPECT_DOUBLE_EQ(stairs.next_ms(), 18.4);
  stairs.answer(true);
  EXPECT_DOUBLE_EQ(stairs.next_ms(), 16.8);
  stairs.answer(false);  // the first reversal: the step is 0.8
  EXPECT_DOUBLE_EQ(stairs.next_ms(), 19.2);
  stairs.answer(false);
  EXPECT_DOUBLE_EQ(stairs.next_ms(), 21.6);
  stairs.answer(true);  // the second: 0.4
  EXPECT_DOUBLE_EQ(stairs.next_ms(), 21.2);
  EXPECT_EQ(stairs.reversals(), 2);
}

TEST(Staircase, TenReversalsEndItAndTheStepHasAFloor) {
  Staircase stairs({});
  bool right = true;
  for (int answer = 0; answer < 11; ++answer, right = !right) {
    EXPECT_FALSE(stairs.is_over());
    stairs.answer(right);
  }
  EXPECT_TRUE(stairs.is_over());
  const double before_ms = stairs.next_ms();
  stairs.answer(true);
  EXPECT_NEAR(before_ms - stairs.next_ms(), 0.01, 1e-12);
}

TEST(Staircase, ARunOfRightAnswersDoublesTheStepAndNoDelayIsBelowTheFloor) {
  Staircase::Settings settings;
  settings.start_ms = 100;
  Staircase stairs(settings);
  for (int answer = 0; answer < 19; ++answer) stairs.answer(true);
  EXPECT_NEAR(stairs.next_ms(), 100 - 19 * 1.6, 1e-9);
  stairs.answer(true);
  EXPECT_NEAR(stairs.next_ms(), 100 - 19 * 1.6 - 3.2, 1e-9);
  for (int answer = 0; answer < 100; ++answer) stairs.answer(true);
  EXPECT_DOUBLE_EQ(stairs.next_ms(), 0.01);
}

TEST(Staircase, ASubjectThatOnlyGuessesComesToAnEnd) {
  Staircase stairs({});
  int trials = 0;
  for (; !stairs.is_over() && trials < 1000; ++trials) stairs.answer(false);
  EXPECT_TRUE(stairs.is_over());
  EXPECT_LE(stairs.next_ms(), 200);
}

TEST(Interleaved, BothStaircasesComeToTheirEnd) {
  Interleaved stairs(7);
  bool was_high = false, was_low = false;
  int trials = 0;
  for (; !stairs.is_over() && trials < 1000; ++trials) {
    was_high |= stairs.next_ms() > 15;
    was_low |= stairs.next_ms() < 1;
    stairs.answer(stairs.next_ms() > 5);
  }
  EXPECT_TRUE(stairs.is_over());
  EXPECT_TRUE(was_high && was_low);
  EXPECT_NEAR(stairs.jnd_ms(), 5, 2);
}

TEST(QuestPlus, ItsIntervalHoldsTheJndOfNineteenInTwentySubjects) {
  constexpr int kSubjects = 60;
  int held = 0;
  double log_error = 0;
  for (int subject = 0; subject < kSubjects; ++subject) {
    const twin::Random random(subject, twin::Stream::person);
    const double jnd_ms = std::exp(random.spread(0, 1) + 1);
    PsychometricBelief belief;
    for (std::uint64_t trial = 0; trial < 100; ++trial) {
      const double delay_ms = belief.most_telling_ms();
      belief.learn(delay_ms, random.uniform(trial, 2) < right_answers(delay_ms, jnd_ms, 2, 0.02));
    }
    const auto estimate = belief.estimate();
    held += estimate.low_ms <= jnd_ms && jnd_ms <= estimate.high_ms;
    log_error += std::log(estimate.jnd_ms / jnd_ms) / kSubjects;
  }
  EXPECT_GE(held, 54);
  EXPECT_NEAR(log_error, 0, 0.1);
}

TEST(Psychometric, TheJndIsRightInThreeOfFourAnswersAndLapsesCostHalf) {
  EXPECT_DOUBLE_EQ(right_answers(4, 4, 2, 0), 0.75);
  EXPECT_NEAR(right_answers(1e-6, 4, 2, 0), 0.5, 1e-6);
  EXPECT_NEAR(right_answers(1e6, 4, 2, 0.1), 0.95, 1e-6);
}

}  // namespace
}  // namespace handcast::study
