// SPDX-License-Identifier: Apache-2.0
#include "tests/services/lab/simulate/run_rig.hpp"

/// The effect of late registration on the light on the hand.
namespace handcast::simulate {
namespace {

nlohmann::json with(const std::string& method, const std::string& motion, double speed,
                    double seconds, int draw_every = 24) {
  return run_rig("twin", motion, seconds,
                 {"cascade.register.method=" + method, "cascade.ladder.rung=register",
                  "twin.speed=" + std::to_string(speed)},
                 draw_every, kWarmUp_s);
}

TEST(LateRegistration, MakesFastHandsAQuarterBetter) {
  const auto none = with("none", "builtin:wave", 3, 0.6),
             mask = with("mask", "builtin:wave", 3, 0.6);
  EXPECT_LT(mask["interior_mm"]["mean"].get<double>(),
            0.75 * none["interior_mm"]["mean"].get<double>());
  EXPECT_LT(mask["interior_mm"]["p95"].get<double>(),
            0.8 * none["interior_mm"]["p95"].get<double>());
  EXPECT_GE(mask["coverage"].get<double>(), none["coverage"].get<double>());
  EXPECT_LE(mask["spill"].get<double>(), none["spill"].get<double>());
  EXPECT_EQ(mask["foldovers"], 0);
}

TEST(LateRegistration, LeavesAStillHandStill) {
  constexpr int kForJitter = 12;
  const auto none = with("none", "builtin:still", 1, 1, kForJitter),
             mask = with("mask", "builtin:still", 1, 1, kForJitter);
  EXPECT_LE(figure(mask, "/jitter_px"), 1.1 * figure(none, "/jitter_px"));
  EXPECT_LE(mask["interior_mm"]["mean"].get<double>(),
            1.03 * none["interior_mm"]["mean"].get<double>());
}

TEST(LateRegistration, GivesTheSameLightTwice) {
  auto once = with("mask", "builtin:shake", 1, 0.1), twice = with("mask", "builtin:shake", 1, 0.1);
  EXPECT_EQ(once["interior_px"], twice["interior_px"]);
  EXPECT_EQ(once["landmark_px"], twice["landmark_px"]);
}

}  // namespace
}  // namespace handcast::simulate
