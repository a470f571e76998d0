// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/show.hpp"

#include <gtest/gtest.h>

#include "services/lab/twin/random.hpp"

namespace handcast::study {
namespace {

constexpr std::int64_t kRefresh_ns = 16'666'667;

/// The times of 21 pictures that take so many refreshes, each with an error of up to `spread`
/// refreshes to either side; `drifts`: errors add up, as nothing waits.
std::vector<std::int64_t> times(double refreshes, double spread, bool drifts) {
  const twin::Random random(1, twin::Stream::image_clutter);
  std::vector<std::int64_t> shown_ns;
  double at = 1000;
  for (std::uint64_t picture = 0; picture < 21; ++picture, at += refreshes) {
    const double error = spread * random.spread(picture, 0);
    if (drifts) at += error;
    shown_ns.push_back(static_cast<std::int64_t>((at + (drifts ? 0 : error)) * kRefresh_ns));
  }
  return shown_ns;
}

TEST(HasWaited, PicturesThatTakeARefreshEachHave) {
  EXPECT_TRUE(has_waited(times(1, 0, false), kRefresh_ns));
  EXPECT_TRUE(has_waited(times(1, 0.15, false), kRefresh_ns)) << "the computer is busy";
  EXPECT_TRUE(has_waited(times(2, 0.1, false), kRefresh_ns)) << "every second refresh is missed";
  EXPECT_TRUE(has_waited(times(1.002, 0, false), kRefresh_ns)) << "59.94 Hz";
}

TEST(HasWaited, FastOnesHaveNot) {
  EXPECT_FALSE(has_waited(times(0.001, 0, false), kRefresh_ns));
  EXPECT_FALSE(has_waited(times(0.3, 0.05, true), kRefresh_ns));
}

TEST(HasWaited, ASlowComputerIsNotTakenForAMonitor) {
  for (const double refreshes : {0.75, 0.9, 1.1, 1.37, 2.6})
    EXPECT_FALSE(has_waited(times(refreshes, 0.2, true), kRefresh_ns)) << refreshes;
}

}  // namespace
}  // namespace handcast::study
