// SPDX-License-Identifier: Apache-2.0
#include "ipc/ring/rhythm.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace handcast::ipc {
namespace {

constexpr std::int64_t kPeriod_ns = 1'904'762;  // 525 Hz
constexpr std::int64_t kStart_ns = 1'000'000'000;

Rhythm regular(int messages) {
  Rhythm rhythm;
  for (int i = 0; i < messages; ++i)
    rhythm.received(static_cast<std::uint64_t>(i) + 1, kStart_ns + i * kPeriod_ns);
  return rhythm;
}

TEST(Rhythm, ARegularStreamIsExpectedShortlyBeforeItsNextMessage) {
  const auto window = regular(20).window();
  ASSERT_TRUE(window);
  const auto due_ns = kStart_ns + 20 * kPeriod_ns;
  EXPECT_LT(window->from_ns, due_ns - 50'000);
  EXPECT_GT(window->from_ns, due_ns - 150'000);
  EXPECT_GT(window->until_ns, due_ns + 200'000);
}

TEST(Rhythm, ANewStreamIsNotPredicted) {
  EXPECT_FALSE(Rhythm().window());
  EXPECT_FALSE(regular(2).window());
}

TEST(Rhythm, MessagesThatWereSkippedCountAsReceived) {
  Rhythm rhythm;
  for (int i = 0; i < 20; ++i)
    rhythm.received(static_cast<std::uint64_t>(i) * 3 + 1, kStart_ns + i * 3 * kPeriod_ns);
  ASSERT_TRUE(rhythm.window());
  EXPECT_NEAR(static_cast<double>(rhythm.window()->from_ns),
              static_cast<double>(kStart_ns + 58 * kPeriod_ns), 150'000.0);
}

TEST(Rhythm, AnIrregularStreamIsNotPredicted) {
  Rhythm rhythm;
  std::int64_t time_ns = kStart_ns;
  for (int i = 0; i < 40; ++i)
    rhythm.received(static_cast<std::uint64_t>(i) + 1, time_ns += i % 2 ? 1'000'000 : 3'000'000);
  EXPECT_FALSE(rhythm.window());
}

TEST(Rhythm, APauseStartsTheAveragesAgain) {
  auto rhythm = regular(20);
  const auto resumed_ns = kStart_ns + 20 * kPeriod_ns + 300'000'000;
  rhythm.received(21, resumed_ns);
  EXPECT_FALSE(rhythm.window());
  for (int i = 1; i < 6; ++i)
    rhythm.received(21 + static_cast<std::uint64_t>(i), resumed_ns + i * kPeriod_ns);
  EXPECT_TRUE(rhythm.window());
}

TEST(Rhythm, NonsenseIsNotPredictedFrom) {
  auto rhythm = regular(20);
  rhythm.received(21, std::numeric_limits<std::int64_t>::max());
  EXPECT_FALSE(rhythm.window());
  rhythm.received(5, std::numeric_limits<std::int64_t>::min());
  EXPECT_FALSE(rhythm.window());
}

}  // namespace
}  // namespace handcast::ipc
