// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/statistics.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "services/studies/base/latin_square.hpp"
#include "tests/services/studies/papers_subjects.hpp"

namespace handcast::study {
namespace {

TEST(Statistics, ThePublishedValuesOfThePaperGiveItsFigures) {
  const auto baseline = summary_of(kPapersBaseline), fill = summary_of(kPapersFill);
  EXPECT_NEAR(baseline.mean, 3.08, 0.005);
  EXPECT_NEAR(baseline.population_sd, 1.38, 0.005);
  EXPECT_NEAR(fill.mean, 6.62, 0.005);
  EXPECT_NEAR(fill.population_sd, 4.54, 0.005);
  const auto test = paired_t_test(kPapersBaseline, kPapersFill);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->freedom, 9u);
  EXPECT_NEAR(test->t, 2.35, 0.005);
  EXPECT_LT(test->p, 0.05);
  EXPECT_GT(test->p, 0.04);
}

TEST(Statistics, StudentsTIsThatOfTheTables) {
  EXPECT_NEAR(t_quantile(0.05, 1), 12.7062, 1e-4);
  EXPECT_NEAR(t_quantile(0.05, 9), 2.26216, 1e-5);
  EXPECT_NEAR(t_quantile(0.01, 30), 2.74999, 1e-4);
  EXPECT_NEAR(two_sided_p(2.26216, 9), 0.05, 1e-6);
  EXPECT_NEAR(two_sided_p(-2.26216, 9), 0.05, 1e-6);
  EXPECT_NEAR(two_sided_p(0, 5), 1, 1e-12);
  EXPECT_NEAR(two_sided_p(12, 117), 0, 1e-15);
}

TEST(Statistics, TheIntervalHoldsTheDifferenceAndTouchesZeroAtFivePercent) {
  const std::vector<double> first{0, 0, 0, 0}, second{1, 2, 3, 4};
  const auto test = paired_t_test(first, second);
  ASSERT_TRUE(test);
  EXPECT_DOUBLE_EQ(test->mean_difference, 2.5);
  EXPECT_NEAR(test->effect_size, 2.5 / 1.2909944, 1e-6);
  EXPECT_NEAR(0.5 * (test->interval_low + test->interval_high), 2.5, 1e-9);
  EXPECT_EQ(test->interval_low > 0, test->p < 0.05);
}

TEST(Statistics, EqualDifferencesAndASingleSubjectHaveNoTest) {
  EXPECT_FALSE(paired_t_test(std::vector{1.0}, std::vector{2.0}));
  EXPECT_FALSE(paired_t_test(std::vector{1.0, 2.0}, std::vector{2.0, 3.0}));
}

TEST(LatinSquare, EachConditionIsOnceInEachPlaceAndEquallyOftenBehindEachOther) {
  for (const std::size_t count : {2u, 3u, 4u, 5u}) {
    const std::size_t rows = count % 2 ? 2 * count : count;
    std::map<std::pair<std::size_t, std::size_t>, int> in_place, behind;
    for (std::size_t subject = 0; subject < rows; ++subject) {
      const auto order = latin_order(subject, count);
      for (std::size_t place = 0; place < count; ++place) {
        ++in_place[{place, order[place]}];
        if (place > 0) ++behind[{order[place - 1], order[place]}];
      }
    }
    EXPECT_EQ(in_place.size(), count * count);
    for (const auto& [place, times] : in_place) EXPECT_EQ(times, static_cast<int>(rows / count));
    EXPECT_EQ(behind.size(), count * (count - 1));
    for (const auto& [pair, times] : behind) EXPECT_EQ(times, static_cast<int>(rows / count));
  }
}

}  // namespace
}  // namespace handcast::study
