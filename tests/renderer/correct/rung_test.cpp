// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/rung.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/renderer/open_hand.hpp"

namespace handcast::renderer {
namespace {

/// The RMS distance that a rung leaves to `q`.
float left_px(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q) {
  const auto off = difference(on_rung(rung, p, q), q);
  float sum = 0;
  for (const glm::vec2& each : off) sum += glm::dot(each, each);
  return std::sqrt(sum / kLandmarks);
}

TEST(Rung, EachReachesTheFieldsThatItsNumbersCanMake) {
  const LandmarkPoints p = open_hand();
  const LandmarkPoints shifted = moved(p, {1, 0, {7, -4}}),
                       turned = moved(p, {1.05f, 0.08f, {7, -4}});
  EXPECT_GT(left_px(Rung::predict, p, shifted), 8);
  EXPECT_LT(left_px(Rung::shift, p, shifted), 1e-3f);
  EXPECT_GT(left_px(Rung::shift, p, turned), 3);
  EXPECT_LT(left_px(Rung::similarity, p, turned), 1e-3f);
  LandmarkPoints bent = turned;
  for (int i = 5; i <= 8; ++i) bent[i] += glm::vec2(10, 0);
  EXPECT_LT(left_px(Rung::fingers, p, bent), 0.5f * left_px(Rung::similarity, p, bent));
}

TEST(Rung, AHigherOneNeverLeavesMore) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const LandmarkPoints p = with_noise(open_hand(), seed),
                         q = with_noise(moved(p, {1.02f, 0.05f, {9, 3}}), seed + 1000);
    float before = left_px(Rung::hold, p, q);
    for (const Rung rung :
         {Rung::predict, Rung::shift, Rung::similarity, Rung::fingers, Rung::landmarks}) {
      const float left = left_px(rung, p, q);
      EXPECT_LE(left, before + 1e-3f) << msg::name_of(rung) << ", seed " << seed;
      before = left;
    }
  }
}

TEST(Rung, AMarkTellsTheRungOfEachHandAndNothingOfOneThatIsNotThere) {
  const auto detail = msg::with_rung(0, msg::Side::right, Rung::hold);
  EXPECT_EQ(msg::rung_in(detail, msg::Side::right), Rung::hold);
  EXPECT_EQ(msg::rung_in(detail, msg::Side::left), std::nullopt);
  EXPECT_EQ(
      msg::rung_in(msg::with_rung(detail, msg::Side::left, Rung::registered), msg::Side::left),
      Rung::registered);
  EXPECT_EQ(msg::rung_in(0xf, msg::Side::left), std::nullopt)
      << "values from shared memory may be invalid";
}

}  // namespace
}  // namespace handcast::renderer
