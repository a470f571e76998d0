// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/comparison.hpp"

#include <gmock/gmock.h>

namespace handcast::study {
namespace {

using testing::ElementsAre;

TEST(Comparison, TheBaselineIsFirstAndSubjectsThatLackAConditionAreLeftOut) {
  const auto comparison = compare({{"1", "fill", 6},
                                   {"1", "baseline", 3},
                                   {"2", "baseline", 4},
                                   {"3", "fill", 8},
                                   {"3", "baseline", 5}});
  ASSERT_TRUE(comparison) << comparison.error().what;
  EXPECT_THAT(comparison->conditions, ElementsAre("baseline", "fill"));
  EXPECT_THAT(comparison->subjects, ElementsAre("1", "3"));
  EXPECT_THAT(comparison->left_out, ElementsAre("2"));
  EXPECT_DOUBLE_EQ(comparison->summaries[0].mean, 4);
}

TEST(Comparison, SeveralValuesOfASubjectCountAsTheirMean) {
  const auto comparison = compare({{"1", "a", 2}, {"1", "a", 4}, {"1", "b", 7}});
  ASSERT_TRUE(comparison);
  EXPECT_DOUBLE_EQ(comparison->values[0][0], 3);
  EXPECT_FALSE(comparison->test);
}

TEST(Comparison, NobodyWithAllConditionsIsAnError) {
  EXPECT_FALSE(compare({{"1", "a", 2}, {"2", "b", 4}}));
  EXPECT_FALSE(compare({}));
}

}  // namespace
}  // namespace handcast::study
