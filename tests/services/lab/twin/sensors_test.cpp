// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>

#include "ipc/base/clock.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

constexpr int kMany = 3000;

/// Mean and standard deviation of a series.
struct Spread {
  double mean = 0, sd = 0;
  explicit Spread(const std::vector<double>& values) {
    mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    for (const double v : values) sd += (v - mean) * (v - mean);
    sd = std::sqrt(sd / static_cast<double>(values.size()));
  }
};

glm::dvec3 position(const msg::HandPose& pose, int joint) {
  const auto& p = pose.joints[joint].position_m;
  return {p[0], p[1], p[2]};
}

TEST(Tracker, SamplesAtItsRateAndArrivesLate) {
  const auto twin = twin_of(rig_with("builtin:still"));
  std::vector<double> steps_ms, ages_ms;
  for (std::uint64_t k = 0; k < kMany; ++k) {
    const auto sample = twin->tracker_sample(k);
    EXPECT_EQ(sample.poses.header.frame_id, k);
    EXPECT_EQ(sample.poses.header.origin_ns, twin->tracker_time_ns(k));
    ages_ms.push_back(ns_to_ms(sample.arrival_ns - sample.poses.header.origin_ns));
    steps_ms.push_back(ns_to_ms(twin->tracker_time_ns(k + 1) - twin->tracker_time_ns(k)));
    EXPECT_GT(steps_ms.back(), 4);
  }
  const Spread step(steps_ms), age(ages_ms);
  EXPECT_NEAR(step.mean, 1000 / 110.6, 0.01);
  EXPECT_GT(step.sd, 0.1) << "the samples of a real tracker jitter";
  EXPECT_NEAR(age.mean, 9.1, 0.03);
  EXPECT_NEAR(age.sd, 0.4, 0.03);
}

TEST(Tracker, APerfectOneReportsTheTruth) {
  const auto twin = twin_of(perfect_rig("builtin:two_hands"));
  const auto sample = twin->tracker_sample(40);
  EXPECT_EQ(sample.arrival_ns, sample.poses.header.origin_ns);
  ASSERT_EQ(sample.poses.count, 2u);
  for (const Side side : {Side::left, Side::right}) {
    const auto truth = *twin->joints(side, sample.poses.header.origin_ns);
    const auto frames = renderer::frames_of(*sample.poses.find(side));
    for (int j = 0; j < msg::kJoints; ++j) {
      EXPECT_LT(glm::distance(place(frames[j]), place(truth[j])), 1e-6);
      EXPECT_LT(glm::distance(frames[j][0], truth[j][0]), 1e-5f);
    }
  }
}

TEST(Tracker, EnlargesAndMisplacesTheHandAsAsked) {
  auto rig = perfect_rig("builtin:wave");
  rig.twin.tracker.scale = 1.05;
  rig.twin.tracker.offset_mm = 5;
  rig.twin.tracker.rotation_deg = 2;
  const auto twin = twin_of(rig);
  for (const std::uint64_t k : {0, 17, 90}) {
    const auto sample = twin->tracker_sample(k);
    const auto& pose = sample.poses.hands[0];
    const auto truth = *twin->joints(Side::left, sample.poses.header.origin_ns);
    EXPECT_NEAR(1e3 * glm::distance(position(pose, 1), place(truth[1])), 5, 0.01);
    const glm::dvec3 seen = position(pose, 15) - position(pose, 1),
                     real = place(truth[15]) - place(truth[1]);
    EXPECT_NEAR(glm::length(seen) / glm::length(real), 1.05, 1e-4);
    const glm::dmat3 turn =
        glm::dmat3(renderer::frames_of(pose)[1]) * glm::transpose(glm::dmat3(truth[1]));
    EXPECT_NEAR(glm::degrees(std::acos((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2)), 2, 0.02);
  }
}

TEST(Tracker, DriftsSlowlyByTheAskedPixels) {
  auto rig = perfect_rig("builtin:still");
  rig.twin.tracker.drift_px = 3;
  const auto twin = twin_of(rig);
  const auto calibration = calib::reference_rig();
  double square = 0, step = 0;
  int count = 0;
  std::vector<glm::dvec2> last(msg::kJoints);
  for (std::uint64_t k = 0; k < 4400; ++k) {
    const auto sample = twin->tracker_sample(k);
    const auto truth = *twin->joints(Side::left, sample.poses.header.origin_ns);
    const auto px = [&](const glm::dvec3& p) {
      return calibration.camera.project(
          glm::dvec3(calibration.camera_from_tracker * glm::dvec4(p, 1)));
    };
    for (int j = 0; j < msg::kJoints; ++j) {
      const glm::dvec2 drift = px(position(sample.poses.hands[0], j)) - px(place(truth[j]));
      square += glm::dot(drift, drift) / 2;
      if (k > 0) step += glm::distance(drift, last[j]);
      last[j] = drift;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(square / count), 3, 0.3);
  EXPECT_LT(step / count, 0.4) << "px from sample to sample";
}

TEST(Tracker, TremblesByTheAskedNoise) {
  auto rig = perfect_rig("builtin:still");
  rig.twin.tracker.noise_mm = 0.1;
  const auto twin = twin_of(rig);
  std::vector<double> errors_mm;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const auto sample = twin->tracker_sample(k);
    const auto truth = *twin->joints(Side::left, sample.poses.header.origin_ns);
    for (int j = 0; j < msg::kJoints; ++j)
      for (int c = 0; c < 3; ++c)
        errors_mm.push_back(1e3 * (position(sample.poses.hands[0], j) - place(truth[j]))[c]);
  }
  const Spread error(errors_mm);
  EXPECT_NEAR(error.mean, 0, 0.003);
  EXPECT_NEAR(error.sd, 0.1, 0.003);
}

TEST(Tracker, LosesTheAskedShareOfSamples) {
  auto rig = rig_with("builtin:still");
  rig.twin.tracker.dropout = 0.2;
  const auto twin = twin_of(rig);
  int lost = 0;
  for (std::uint64_t k = 0; k < kMany; ++k) lost += twin->tracker_sample(k).poses.count == 0;
  EXPECT_NEAR(lost / double(kMany), 0.2, 0.03);
}

TEST(Detector, IsLateNoisyAndAtTimesBlind) {
  auto rig = rig_with("builtin:wave");
  rig.twin.detector.dropout = 0.1;
  const auto twin = twin_of(rig);
  std::vector<double> ages_ms, errors_px;
  int lost = 0;
  for (std::uint64_t n = 0; n < kMany; ++n) {
    const std::int64_t origin_ns = twin->camera_origin_ns(8 * n);
    const auto detection = twin->detect(n, 8 * n, origin_ns);
    EXPECT_EQ(detection.landmarks.header.frame_id, 8 * n);
    EXPECT_EQ(detection.landmarks.header.origin_ns, origin_ns);
    ages_ms.push_back(ns_to_ms(detection.age_ns));
    if (detection.landmarks.count == 0 && ++lost) continue;
    const auto truth = *twin->landmarks(Side::left, origin_ns);
    const auto& hand = *detection.landmarks.find(Side::left);
    EXPECT_FLOAT_EQ(hand.presence, 0.95f);
    for (int i = 0; i < msg::kLandmarks; ++i) {
      EXPECT_EQ(hand.points[i].confidence, 1);
      errors_px.push_back(hand.points[i].x_px - truth[i].x);
      errors_px.push_back(hand.points[i].y_px - truth[i].y);
    }
  }
  const Spread age(ages_ms), error(errors_px);
  EXPECT_NEAR(age.mean, 16.2, 0.15);
  EXPECT_NEAR(age.sd, 1.9, 0.1);
  EXPECT_NEAR(error.mean, 0, 0.02);
  EXPECT_NEAR(error.sd, 1, 0.02);
  EXPECT_NEAR(lost / double(kMany), 0.1, 0.02);
}

TEST(Detector, PointsOutsideTheImageAreNotSeen) {
  HANDCAST_NEEDS_RECORDINGS();
  const auto twin = twin_of(rig_with((outside_data() / "lmc" / "translation").string()));
  int outside = 0;
  for (std::uint64_t n = 0; n < 300; ++n) {
    const std::int64_t origin_ns = ms_to_ns(16.0 * static_cast<double>(n));
    const auto truth = *twin->landmarks(Side::left, origin_ns);
    const auto detection = twin->detect(n, n, origin_ns);
    for (int i = 0; i < msg::kLandmarks; ++i) {
      if (std::abs(truth[i].y - 540) < 8) continue;  // lens distortion displaces the border
      EXPECT_EQ(detection.landmarks.hands[0].points[i].confidence, truth[i].y < 540 ? 1 : 0);
      outside += truth[i].y > 540;
    }
  }
  EXPECT_GT(outside, 0);
}

TEST(Twin, TheSeedIsTheOnlyChance) {
  auto rig = rig_with("builtin:open_close");
  const auto one = twin_of(rig), same = twin_of(rig);
  rig.twin.seed = 2;
  const auto other = twin_of(rig);
  const auto a = one->tracker_sample(500), b = same->tracker_sample(500),
             c = other->tracker_sample(500);
  EXPECT_EQ(a.arrival_ns, b.arrival_ns);
  EXPECT_NE(a.arrival_ns, c.arrival_ns);
  for (int j = 0; j < msg::kJoints; ++j) {
    EXPECT_EQ(a.poses.hands[0].joints[j].position_m, b.poses.hands[0].joints[j].position_m);
    EXPECT_NE(a.poses.hands[0].joints[j].position_m, c.poses.hands[0].joints[j].position_m);
  }
  const auto seen = one->detect(3, 30, 60'000'000), again = same->detect(3, 30, 60'000'000),
             elsewhere = other->detect(3, 30, 60'000'000);
  EXPECT_EQ(seen.age_ns, again.age_ns);
  EXPECT_EQ(seen.landmarks.hands[0].points[8].x_px, again.landmarks.hands[0].points[8].x_px);
  EXPECT_NE(seen.age_ns, elsewhere.age_ns);
  EXPECT_NE(one->true_hand(Side::left).mesh.positions, other->true_hand(Side::left).mesh.positions);
  EXPECT_EQ(one->true_hand(Side::left).mesh.positions, same->true_hand(Side::left).mesh.positions);
}

TEST(Camera, FramesComeAtTheRateAndArriveAfterExposureAndDelivery) {
  const auto twin = twin_of(rig_with("builtin:still"));
  EXPECT_EQ(twin->camera_origin_ns(0), 0);
  EXPECT_EQ(twin->camera_origin_ns(525), 1'000'000'000);
  EXPECT_EQ(twin->camera_arrival_ns(525) - twin->camera_origin_ns(525), 925'000 + 300'000);
}

}  // namespace
}  // namespace handcast::twin
