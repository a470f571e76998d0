// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/side_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace handcast::pose::stereo {
namespace {

constexpr std::int64_t kEvidenceStep_ns = 50'000'000;

/// After so many comparisons of these costs and votes.
double log_odds_after(int comparisons, double cost, double cost_of_other, int votes) {
  SideEvidence evidence;
  for (int i = 0; i < comparisons; ++i)
    evidence.compare(i * kEvidenceStep_ns, cost, cost_of_other, votes);
  return evidence.log_odds();
}

TEST(SideEvidence, OneComparisonThatIsClearIsEnoughIfTheDetectorsDisagree) {
  EXPECT_GE(log_odds_after(1, 35, 23, 0), 3.5);
  EXPECT_LE(log_odds_after(1, 23, 35, 0), -3.5);
}

TEST(SideEvidence, AgainstBothDetectorsItMustBeClearer) {
  EXPECT_LT(log_odds_after(1, 23, 20, -2), 1);
  EXPECT_GE(log_odds_after(1, 35, 20, -2), 2.5);
}

TEST(SideEvidence, ImagesInAShortTimeCountAsOne) {
  const double one = log_odds_after(1, 22, 20, 0);
  EXPECT_LT(log_odds_after(2, 22, 20, 0), 1.2 * one);
  EXPECT_GE(log_odds_after(9, 22, 20, 0), 1.9 * one);
}

TEST(SideEvidence, LandmarksThatFitNeitherHandSayNothing) {
  EXPECT_EQ(log_odds_after(20, 179, 147, 0), 0);
}

TEST(SideEvidence, VotesOfAHandThatIsPartlySeenDoNotDelayTheFirstComparison) {
  SideEvidence evidence;
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(evidence.is_due(i * 8'000'000));
    evidence.vote(i * 8'000'000, -1);
  }
  evidence.compare(80'000'000, 35, 23, 0);
  EXPECT_GE(evidence.log_odds(), 3);
}

TEST(SideEvidence, VotesAloneDecideInSeconds) {
  SideEvidence evidence;
  int images = 0;
  for (; evidence.log_odds() < 2.5; ++images) {
    ASSERT_LT(images, 1000);
    evidence.vote(images * 8'000'000, 1);
  }
  EXPECT_GT(images, 100);
}

TEST(SideEvidence, WhatIsSureIsComparedRarelyAndStillCorrected) {
  SideEvidence evidence;
  EXPECT_TRUE(evidence.is_due(0));
  evidence.compare(0, 20, 22, 0);
  EXPECT_FALSE(evidence.is_due(kEvidenceStep_ns / 2));
  EXPECT_TRUE(evidence.is_due(kEvidenceStep_ns));
  for (int i = 1; i < 100; ++i) evidence.compare(i * kEvidenceStep_ns, 20, 40, -2);
  EXPECT_FALSE(evidence.is_due(100 * kEvidenceStep_ns));
  int wrong = 0;
  for (; evidence.log_odds() < 3.5; ++wrong) {
    ASSERT_LT(wrong, 30);
    evidence.compare((100 + wrong) * kEvidenceStep_ns, 40, 20, 2);
  }
}

TEST(SideEvidence, WhatIsForgottenIsNotComparedAtOnceAgainButCountsWholeThen) {
  SideEvidence evidence;
  evidence.compare(0, 20, 35, 0);
  evidence.forget();
  EXPECT_EQ(evidence.log_odds(), 0);
  EXPECT_FALSE(evidence.is_due(kEvidenceStep_ns / 2));
  EXPECT_TRUE(evidence.is_due(kEvidenceStep_ns));
  EXPECT_TRUE(evidence.is_due(-kEvidenceStep_ns)) << "a clock that began anew";
  evidence.compare(kEvidenceStep_ns, 35, 23, 0);
  EXPECT_GE(evidence.log_odds(), 3.5);
}

TEST(SideEvidence, CostsThatAreNoNumbersSayNothing) {
  EXPECT_EQ(log_odds_after(3, NAN, 20, 0), 0);
  EXPECT_EQ(log_odds_after(3, 20, NAN, 0), 0);
}

}  // namespace
}  // namespace handcast::pose::stereo
