// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/jitter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace handcast::simulate {
namespace {

constexpr double kStill = 0;

/// The jitter of one point that moves as `at(seconds)` says, seen at `rate_hz` for `seconds`.
template <class At>
std::optional<double> jitter_of(double rate_hz, double seconds, const At& at,
                                double speed_m_s = kStill) {
  JitterMeter meter;
  for (int i = 0; i < static_cast<int>(seconds * rate_hz); ++i) {
    const double time_s = 1 + i / rate_hz;
    meter.add(msg::Side::left, static_cast<std::int64_t>(1e9 * time_s), {glm::dvec2(at(time_s))},
              speed_m_s);
  }
  return meter.rms_px();
}

/// A wobble in x with an RMS of 1 px.
auto wobble(double hz) {
  return [hz](double seconds) {
    return glm::dvec2(std::numbers::sqrt2 * std::sin(2 * std::numbers::pi * hz * seconds), 0);
  };
}

TEST(Jitter, AWobbleThatPeopleSeeIsReadInFull) {
  for (const double rate_hz : {118.0, 946.0})
    for (const double hz : {3.0, 10.0, 20.0}) {
      EXPECT_GE(*jitter_of(rate_hz, 5, wobble(hz)), 0.9) << hz << " Hz at " << rate_hz;
      EXPECT_LE(*jitter_of(rate_hz, 5, wobble(hz)), 1.02) << hz << " Hz at " << rate_hz;
    }
}

TEST(Jitter, WhatIsSlowerOrFasterThanTremblingIsNotJitter) {
  EXPECT_LT(*jitter_of(946, 10, wobble(0.1)), 0.1);
  EXPECT_LT(*jitter_of(946, 5, wobble(200)), 0.1);
  // The rates of the paper's detector, the tracker and our network, as config/sweeps/jitter.toml
  // samples them.
  for (const double hz : {61.7, 110.6, 200.0})
    EXPECT_LT(*jitter_of(946.0 / 3, 5, wobble(hz)), 0.3) << hz << " Hz";
  EXPECT_EQ(*jitter_of(118, 2, [](double) { return glm::dvec2(7, -3); }), 0)
      << "a constant error is not";
}

TEST(Jitter, AlternationFromFrameToFrameIsReadAtTheRateOfTheFrames) {
  const auto alternating = [](double seconds) {
    return glm::dvec2(std::fmod(seconds * 50, 2.0) < 1 ? 1 : -1, 0);
  };
  EXPECT_GT(*jitter_of(118, 5, alternating), 0.5) << "25 Hz";
}

TEST(Jitter, OfAFastHandIsNotCounted) {
  EXPECT_FALSE(jitter_of(118, 2, wobble(10), 2 * JitterMeter::kSlow_m_s));
}

TEST(Jitter, IsNotMeasuredFromFramesThatAreTooRare) { EXPECT_FALSE(jitter_of(59, 5, wobble(10))); }

TEST(Jitter, AHandThatComesBackElsewhereHasNotTrembled) {
  JitterMeter meter;
  for (int i = 0; i < 400; ++i) {
    if (i >= 100 && i < 200) continue;
    const double place_px = i < 100 ? 0 : 50;
    meter.add(msg::Side::right, 1'000'000'000 + i * 8'000'000LL, {glm::dvec2(place_px, 0)}, kStill);
  }
  EXPECT_LT(*meter.rms_px(), 1e-6);
}

TEST(Jitter, APartOfTheHandThatDisappearsForAWhileStartsAnew) {
  JitterMeter meter;
  for (int i = 0; i < 400; ++i) {
    const std::optional<glm::dvec2> hidden, shown(glm::dvec2(i < 100 ? 0 : 50, 0));
    meter.add(msg::Side::right, 1'000'000'000 + i * 8'000'000LL,
              {i >= 100 && i < 200 ? hidden : shown}, kStill);
  }
  EXPECT_LT(*meter.rms_px(), 1e-6);
}

}  // namespace
}  // namespace handcast::simulate
