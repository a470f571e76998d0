// SPDX-License-Identifier: Apache-2.0
// The twin's tracker has moved, or it has not: the watch must tell the two apart, whoever the hand
// is of.
#include "services/pose/drift/calibration_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "calib/drift/correction.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::pose {
namespace {

/// A person, a tracker and a detector with the errors of real ones, and a tracker whose place was
/// measured: what is constant in its own space is in the calibration.
config::Rig rig_of(int seed) {
  config::Rig rig;
  rig.twin.seed = seed;
  rig.twin.motion = "builtin:places";
  rig.twin.shape.length_spread = 0.08;
  rig.twin.shape.width_spread = 0.15;
  rig.twin.tracker.offset_mm = 0;
  rig.twin.tracker.joint_offset_mm = 3.5;
  rig.twin.tracker.drift_px = 3;
  rig.twin.tracker.noise_mm = 0.3;
  rig.twin.detector.noise_px = 1.5;
  rig.twin.detector.bias_px = 3;
  rig.twin.detector.near_outliers = 0.05;
  rig.twin.detector.clock_skew_ms = 3;
  return rig;
}

/// Everything that tracker and detector say until a time, in its order.
calib::Drift watched(const config::Rig& rig, double seconds,
                     const config::Drift& settings = {.watch = config::DriftWatch::always}) {
  const auto twin = twin::Twin::create(rig, calib::reference_rig()).value();
  CalibrationWatch watch(settings, calib::reference_rig());
  std::uint64_t k = 0;
  std::int64_t camera_ns = 0;
  for (std::uint64_t n = 0; camera_ns < seconds_to_ns(seconds); ++n) {
    camera_ns = static_cast<std::int64_t>(n) * 20'000'000;
    const auto detection = twin->detect(n, n, camera_ns);
    watch.see(detection.landmarks);
    for (; twin->tracker_time_ns(k) < camera_ns + 10'000'000; ++k)
      watch.see(twin->tracker_sample(k).poses);
  }
  return watch.drift();
}

TEST(CalibrationWatch, ATrackerThatHasMovedBy5mmAnd1DegreeIsReportedForEveryPerson) {
  for (int seed = 1; seed <= 20; ++seed) {
    auto rig = rig_of(seed);
    rig.twin.geometry.tracker_mm = 5;
    rig.twin.geometry.tracker_deg = 1;
    const auto drift = watched(rig, 90);
    EXPECT_TRUE(drift.moved) << seed << ": " << drift.across_mm << " mm +- "
                             << 2 * drift.across_sd_mm << ", " << drift.turn_deg << " deg +- "
                             << 2 * drift.turn_sd_deg << ", evidence " << drift.evidence;
  }
}

TEST(CalibrationWatch, ATrackerThatHasNotMovedIsReportedForNoPerson) {
  double most = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const auto drift = watched(rig_of(seed), 90);
    EXPECT_FALSE(drift.moved) << seed << ": " << drift.across_mm << " mm +- "
                              << 2 * drift.across_sd_mm << ", " << drift.turn_deg << " deg +- "
                              << 2 * drift.turn_sd_deg << ", evidence " << drift.evidence;
    most = std::max(most, drift.evidence);
    EXPECT_GT(drift.places, 15) << seed;
  }
  std::printf("[ evidence ] of 20 persons at most %.1f\n", most);
}

TEST(CalibrationWatch, NothingIsLearntWhileTheHandMoves) {
  auto rig = rig_of(1);
  rig.twin.motion = "builtin:wave";
  rig.twin.geometry.tracker_mm = 10;
  const auto drift = watched(rig, 20);
  EXPECT_EQ(drift.places, 0);
  EXPECT_EQ(drift.across_mm, 0);
}

TEST(CalibrationWatch, WatchesOnlyAMeasuredTrackerByDefault) {
  auto calibration = calib::reference_rig();
  EXPECT_FALSE(CalibrationWatch({}, calibration).is_on());
  calibration.made.tracker = "2026-11-24: 1.2 px held out";
  EXPECT_TRUE(CalibrationWatch({}, calibration).is_on());
  EXPECT_FALSE(CalibrationWatch({.watch = config::DriftWatch::never}, calibration).is_on());
  const auto drift = watched(rig_of(1), 10, {.watch = config::DriftWatch::never});
  EXPECT_EQ(drift.places, 0);
}

TEST(CalibrationWatch, LandmarksOfAnotherCalibrationAreLeftOut) {
  auto calibration = calib::reference_rig();
  calibration.id = 7;
  CalibrationWatch watch({.watch = config::DriftWatch::always}, calibration);
  const auto rig = rig_of(1);
  const auto twin = twin::Twin::create(rig, calibration).value();
  std::uint64_t k = 0;
  for (std::uint64_t n = 0; n < 300; ++n) {
    const auto time_ns = static_cast<std::int64_t>(n) * 20'000'000;
    auto landmarks = twin->detect(n, n, time_ns).landmarks;
    landmarks.calibration = 8;
    watch.see(landmarks);
    for (; twin->tracker_time_ns(k) < time_ns + 10'000'000; ++k)
      watch.see(twin->tracker_sample(k).poses);
  }
  EXPECT_EQ(watch.drift().places, 0);
}

TEST(DriftNote, ComesBackFromItsNumberAndIsBounded) {
  const msg::DriftNote note{true, 12, 5.13, 0.987};
  const auto back = msg::drift_note_in(msg::detail_of(note));
  EXPECT_TRUE(back.moved);
  EXPECT_EQ(back.places, 12U);
  EXPECT_NEAR(back.across_mm, 5.13, 0.051);
  EXPECT_NEAR(back.turn_deg, 0.987, 0.0051);
  const auto most = msg::drift_note_in(msg::detail_of(msg::DriftNote{false, 1000, 1e9, 1e9}));
  EXPECT_FALSE(most.moved);
  EXPECT_EQ(most.places, 127U);
  EXPECT_NEAR(most.across_mm, 204.7, 0.01);
  EXPECT_EQ(msg::detail_of(msg::DriftNote{}), 0U);
}

}  // namespace
}  // namespace handcast::pose
