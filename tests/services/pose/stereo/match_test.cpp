// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/match.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/services/pose/stereo/two_views.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr int kLeft = 0, kRight = 1;

class MatchTest : public testing::Test {
 protected:
  /// What the views report of two hands: the left one first.
  Reports reports_at(std::int64_t time_ns) {
    Reports reports;
    for (int v = 0; v < kViews; ++v) {
      const auto seen = world_.seen(v, time_ns);
      for (const auto side : {msg::Side::left, msg::Side::right})
        reports[static_cast<std::size_t>(v)].push_back({side, 1, read(*seen.find(side)).value()});
    }
    return reports;
  }
  Matches matches_of(const Reports& reports, const std::array<Expected, 2>& expected = {}) const {
    return match(skeleton_, views_, reports, expected);
  }

  TwoViews world_{with_noise(2), "two_hands"};
  Views views_ = views_of(two_cameras()).value();
  Skeleton skeleton_{renderer::load_hand_or_default({}, msg::Side::left).value()};
};

TEST_F(MatchTest, HandsThatAViewReportsInAnotherOrderAreFound) {
  auto reports = reports_at(0);
  EXPECT_EQ(matches_of(reports), (Matches{{{0, 0}, {1, 1}}}));
  std::swap(reports[1][0], reports[1][1]);
  EXPECT_EQ(matches_of(reports), (Matches{{{0, 1}, {1, 0}}}));
}

TEST_F(MatchTest, AViewThatExchangesTheSidesDoesNotExchangeTheHands) {
  for (std::int64_t time_ns = 0; time_ns < 2'000'000'000; time_ns += 200'000'000) {
    auto reports = reports_at(time_ns);
    std::swap(reports[1][0].side, reports[1][1].side);
    const Matches matches = matches_of(reports);
    for (const auto& [first, second] : matches)
      EXPECT_EQ(first, second) << "one hand in both views, at " << time_ns;
  }
}

TEST_F(MatchTest, AHandThatOneViewAloneSeesIsNotPairedWithTheOther) {
  auto reports = reports_at(0);
  reports[1].erase(reports[1].begin());  // the left hand
  EXPECT_EQ(matches_of(reports), (Matches{{{0, -1}, {1, 0}}}));
  reports[0].pop_back();  // the right hand
  const Matches none = matches_of(reports);
  EXPECT_TRUE(none[kLeft][0] != 0 || none[kLeft][1] != 0) << "two hands are not one";
  EXPECT_TRUE(none[kRight][0] != 0 || none[kRight][1] != 0);
}

TEST_F(MatchTest, AHandIsWhereItIsExpectedWhateverSideTheDetectorsSay) {
  auto reports = reports_at(0);
  std::array<Expected, 2> expected;
  for (int side = 0; side < 2; ++side)
    expected[side] = {reports[0][side].seen.px, reports[1][side].seen.px};
  for (auto& view : reports) std::swap(view[0].side, view[1].side);
  EXPECT_EQ(matches_of(reports, expected), (Matches{{{0, 0}, {1, 1}}}));
  for (auto& view : reports) view.pop_back();
  EXPECT_EQ(matches_of(reports, expected), (Matches{{{0, 0}, {-1, -1}}}));
}

TEST_F(MatchTest, NoReportsAreNoMatch) {
  EXPECT_EQ(matches_of({}), (Matches{{{-1, -1}, {-1, -1}}}));
}

TEST_F(MatchTest, OneHandFitsItselfAndNotTheOther) {
  const auto reports = reports_at(0);
  const double same = misfit_of(skeleton_, views_, reports[0][0].seen, reports[1][0].seen);
  EXPECT_LT(same, 2);
  EXPECT_GT(misfit_of(skeleton_, views_, reports[0][0].seen, reports[1][1].seen), 4 * same);
}

}  // namespace
}  // namespace handcast::pose::stereo
