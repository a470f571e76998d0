// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "ipc/base/clock.hpp"
#include "tests/services/lab/twin/world.hpp"

/// Clocks that are not the rig's, and items that come late or never.
namespace handcast::twin {
namespace {

double rms(const std::vector<double>& values) {
  double square = 0;
  for (const double v : values) square += v * v / static_cast<double>(values.size());
  return std::sqrt(square);
}

TEST(Clocks, DriftRunsOnUntilTheMapIsUpdatedOnceASecond) {
  auto rig = perfect_rig("builtin:still");
  rig.twin.image.clock.drift_ppm = 100;
  rig.twin.tracker.clock.drift_ppm = -100;
  const auto twin = twin_of(rig);
  for (const std::uint64_t k : {0u, 525u, 5250u})
    EXPECT_EQ(twin->camera_stamp_ns(k), twin->camera_origin_ns(k));
  EXPECT_NEAR(static_cast<double>(twin->camera_stamp_ns(524) - twin->camera_origin_ns(524)), 99'800,
              50);
  for (std::uint64_t k = 0; k < 400; ++k) {
    const auto error_ns = twin->tracker_sample(k).poses.header.origin_ns - twin->tracker_time_ns(k);
    EXPECT_LE(error_ns, 0);
    EXPECT_GE(error_ns, -100'000);
  }
}

TEST(Clocks, StampsScatterAndAscend) {
  auto rig = perfect_rig("builtin:still");
  rig.twin.image.clock.jitter_ms = 0.2;
  rig.twin.tracker.clock.jitter_ms = 1;
  const auto twin = twin_of(rig);
  std::vector<double> camera_ms, tracker_ms;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    camera_ms.push_back(ns_to_ms(twin->camera_stamp_ns(k) - twin->camera_origin_ns(k)));
    const auto stamp_ns = twin->tracker_sample(k).poses.header.origin_ns;
    tracker_ms.push_back(ns_to_ms(stamp_ns - twin->tracker_time_ns(k)));
    EXPECT_LT(twin->camera_stamp_ns(k), twin->camera_stamp_ns(k + 1));
    EXPECT_LT(stamp_ns, twin->tracker_sample(k + 1).poses.header.origin_ns);
  }
  EXPECT_NEAR(rms(camera_ms), 0.2, 0.01);
  EXPECT_NEAR(rms(tracker_ms), 1, 0.06);
}

TEST(Clocks, HoweverLargeTheScatterStampsAscend) {
  auto rig = perfect_rig("builtin:still");
  rig.twin.image.clock.jitter_ms = 20;
  rig.twin.tracker.clock.jitter_ms = 20;
  const auto twin = twin_of(rig);
  for (std::uint64_t k = 0; k < 1000; ++k) {
    EXPECT_LT(twin->camera_stamp_ns(k), twin->camera_stamp_ns(k + 1));
    EXPECT_LT(twin->tracker_sample(k).poses.header.origin_ns,
              twin->tracker_sample(k + 1).poses.header.origin_ns);
  }
}

TEST(Clocks, ADetectionShowsTheTrueImageUnderTheStampOfItsFrame) {
  auto rig = perfect_rig("builtin:shake");
  rig.twin.image.clock.jitter_ms = 0.3;
  rig.twin.detector.clock_skew_ms = 2;
  const auto twin = twin_of(rig);
  for (std::uint64_t k = 200; k < 260; ++k) {
    const auto stamp_ns = twin->camera_stamp_ns(k);
    const auto landmarks = twin->detect(k, k, stamp_ns).landmarks;
    EXPECT_EQ(landmarks.header.origin_ns, stamp_ns + 2'000'000);
    const auto truth = *twin->landmarks(Side::left, twin->camera_origin_ns(k));
    EXPECT_LT(glm::distance(
                  glm::vec2(landmarks.hands[0].points[8].x_px, landmarks.hands[0].points[8].y_px),
                  truth[8]),
              1e-3f);
  }
}

TEST(Losses, TheAskedShareOfFramesNeverArrives) {
  auto rig = rig_with("builtin:still");
  const auto whole = twin_of(rig);
  rig.twin.image.lost = 0.2;
  const auto twin = twin_of(rig);
  int lost = 0;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    EXPECT_FALSE(whole->camera_lost(k));
    lost += twin->camera_lost(k);
  }
  EXPECT_NEAR(lost, 600, 90);
}

/// Arrivals of a sensor with bursts beside those without.
template <class Arrival>
void expect_bursts(const Arrival& arrival_ns, const Arrival& alone_ns) {
  int late = 0;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    EXPECT_GE(arrival_ns(k), alone_ns(k));
    EXPECT_LE(arrival_ns(k), arrival_ns(k + 1)) << "none overtakes the next";
    if (arrival_ns(k) == alone_ns(k)) continue;
    ++late;
    EXPECT_EQ(arrival_ns(k), arrival_ns(k + 1)) << "late ones come with the next one";
  }
  EXPECT_NEAR(late, 900, 100);
}

using Arrival = std::function<std::int64_t(std::uint64_t)>;

TEST(Losses, AShareOfFramesAndSamplesArrivesWithTheNextOne) {
  auto rig = rig_with("builtin:still");
  rig.twin.tracker.age_sd_ms = 0;
  const auto punctual = twin_of(rig);
  rig.twin.image.burst = 0.3;
  rig.twin.tracker.burst = 0.3;
  const auto late = twin_of(rig);
  expect_bursts<Arrival>([&](auto k) { return late->camera_arrival_ns(k); },
                         [&](auto k) { return punctual->camera_arrival_ns(k); });
  expect_bursts<Arrival>([&](auto k) { return late->tracker_sample(k).arrival_ns; },
                         [&](auto k) { return punctual->tracker_sample(k).arrival_ns; });
}

}  // namespace
}  // namespace handcast::twin
