// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/finger_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>

/// @file
/// Fingers that a detector takes for others: a hand whose landmarks are 40 px apart.

namespace handcast::renderer {
namespace {

using Verdict = FingerSteps::Verdict;

constexpr int kIndex = 1, kMiddle = 2;
constexpr std::int64_t kImage_ns = 5'000'000;

ExpectedPoints hand() {
  ExpectedPoints hand;
  for (int i = 0; i < kLandmarks; ++i)
    hand.px[i] = {40.0f * static_cast<float>((i + 3) / 4), 40.0f * static_cast<float>(i % 4)};
  hand.known.fill(true);
  return hand;
}

ExpectedPoints moved(ExpectedPoints hand, int finger, float x_px) {
  for (int k = 1; k <= 4; ++k) hand.px[4 * finger + k].x += x_px;
  return hand;
}

msg::HandLandmarks seen_at(const ExpectedPoints& places, float sigma_px = 0) {
  msg::HandLandmarks seen;
  for (int i = 0; i < kLandmarks; ++i)
    seen.points[i] = {places.px[i].x, places.px[i].y, 1, sigma_px};
  return seen;
}

TEST(FingerSteps, LandmarksWhereTheyAreExpectedAreUsual) {
  FingerSteps steps;
  const auto seen = seen_at(moved(hand(), kIndex, 5));
  for (const Verdict verdict : steps.judge(0, seen, hand(), hand(), hand()))
    EXPECT_EQ(verdict, Verdict::usual);
}

TEST(FingerSteps, AFingerThatJumpsAwayIsLeftOutForHalfASecond) {
  FingerSteps steps;
  const auto seen = seen_at(moved(hand(), kIndex, 20));
  std::int64_t held_ns = 0;
  // Its own motion soon follows the wrong places, which must not excuse them.
  for (; held_ns < 2'000'000'000; held_ns += kImage_ns) {
    const auto own = held_ns == 0 ? hand() : moved(hand(), kIndex, 20);
    const auto verdicts = steps.judge(held_ns, seen, hand(), hand(), own);
    EXPECT_EQ(verdicts[kMiddle], Verdict::usual);
    if (verdicts[kIndex] == Verdict::anew) break;
    ASSERT_EQ(verdicts[kIndex], Verdict::hold);
  }
  EXPECT_EQ(held_ns, 500'000'000);
}

TEST(FingerSteps, AFingerThatComesBackToTheHandBeginsAnewAtOnce) {
  FingerSteps steps;
  const auto wrong = moved(hand(), kIndex, 20);
  EXPECT_EQ(steps.judge(0, seen_at(hand()), wrong, hand(), wrong)[kIndex], Verdict::anew);
}

TEST(FingerSteps, AfterAStepOfTheTrackerAFingerBeginsAnewAtOnce) {
  FingerSteps steps;
  const auto by_tracker = moved(hand(), kIndex, 20);
  // Also of an unsure finger: a sigma is how far the landmarks are off, not how much they move.
  const auto verdicts = steps.judge(0, seen_at(hand(), 7), by_tracker, by_tracker, hand());
  EXPECT_EQ(verdicts[kIndex], Verdict::anew);
  EXPECT_EQ(verdicts[kMiddle], Verdict::usual);
}

TEST(FingerSteps, AnUnsureFingerMayStep) {
  FingerSteps steps;
  const auto places = moved(hand(), kIndex, 20);
  EXPECT_EQ(steps.judge(0, seen_at(places, 7), hand(), hand(), hand())[kIndex], Verdict::usual);
  EXPECT_EQ(steps.judge(0, seen_at(places, 1), hand(), hand(), hand())[kIndex], Verdict::hold);
}

ExpectedPoints exchanged() {
  ExpectedPoints hand = renderer::hand();
  for (int k = 1; k <= 4; ++k) std::swap(hand.px[4 * kIndex + k], hand.px[4 * kMiddle + k]);
  return hand;
}

/// How long the fingers of a detector that exchanges two are put back, up to 2 s.
std::int64_t mended_ns(const ExpectedPoints& by_tracker) {
  FingerOrder order;
  const float right_px = hand().px[4 * kIndex + 1].x;
  for (std::int64_t now_ns = 0; now_ns < 2'000'000'000; now_ns += kImage_ns) {
    const auto mended = order.mended(now_ns, seen_at(exchanged()), hand(), by_tracker);
    if (mended.points[4 * kIndex + 1].x_px != right_px) return now_ns;
  }
  return 2'000'000'000;
}

TEST(FingerOrder, ExchangedFingersArePutBackAsLongAsTheTrackerAgrees) {
  EXPECT_EQ(mended_ns(hand()), 2'000'000'000);
  EXPECT_EQ(mended_ns(exchanged()), 500'000'000);
  EXPECT_EQ(mended_ns({}), 500'000'000);
}

TEST(FingerOrder, FingersSideBySideMayBeNoiseAndStay) {
  FingerOrder order;
  const auto close = moved(hand(), kMiddle, -30);
  auto seen = seen_at(close);
  std::swap_ranges(&seen.points[5], &seen.points[9], &seen.points[9]);
  EXPECT_EQ(order.mended(0, seen, close, close).points[5].x_px, close.px[9].x);
}

TEST(FingerOrder, FingersAtTheirPlacesStay) {
  FingerOrder order;
  const auto near = moved(hand(), kIndex, 12);
  EXPECT_EQ(order.mended(0, seen_at(near), hand(), hand()).points[5].x_px, near.px[5].x);
}

}  // namespace
}  // namespace handcast::renderer
