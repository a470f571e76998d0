// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/detector.hpp"
#include "tests/services/lab/twin/world.hpp"

/// The error of a landmark detector that depends on the pose.
namespace handcast::twin {
namespace {

using Landmarks = std::array<glm::vec2, msg::kLandmarks>;

/// The true hand at a time, in camera space.
JointFrames camera_frames_at(const Twin& twin, double seconds) {
  static const auto kCameraFromTracker = glm::mat4(calib::reference_rig().camera_from_tracker);
  auto frames = *twin.joints(Side::left, seconds_to_ns(seconds));
  for (auto& frame : frames) frame = kCameraFromTracker * frame;
  return frames;
}

/// A detector with a bias alone.
config::Rig biased_rig(const std::string& motion, double bias_px) {
  auto rig = perfect_rig(motion);
  rig.twin.detector.noise_px = 0;
  rig.twin.detector.bias_px = bias_px;
  return rig;
}

using Errors = std::array<glm::dvec2, msg::kLandmarks>;

Errors errors_at(const Twin& twin, double seconds) {
  const auto time_ns = seconds_to_ns(seconds);
  const auto found = twin.detect(0, 0, time_ns).landmarks.hands[0];
  const auto truth = *twin.landmarks(Side::left, time_ns);
  Errors errors;
  for (std::size_t i = 0; i < truth.size(); ++i)
    errors[i] = glm::dvec2(found.points[i].x_px, found.points[i].y_px) - glm::dvec2(truth[i]);
  return errors;
}

double square_of(const Errors& errors, std::initializer_list<std::size_t> landmarks) {
  double square = 0;
  for (const auto i : landmarks)
    square += glm::dot(errors[i], errors[i]) / static_cast<double>(2 * landmarks.size());
  return square;
}

/// Mean over persons and time of the autocorrelation of the error at a delay.
double autocorrelation(config::Rig rig, double delay_s) {
  double product = 0, square = 0;
  for (rig.twin.seed = 1; rig.twin.seed <= 6; ++rig.twin.seed) {
    const auto twin = twin_of(rig);
    for (double t = 0; t < 4; t += 0.05) {
      const auto now = errors_at(*twin, t), later = errors_at(*twin, t + delay_s);
      for (std::size_t i = 0; i < now.size(); ++i) {
        product += glm::dot(now[i], later[i]);
        square += (glm::dot(now[i], now[i]) + glm::dot(later[i], later[i])) / 2;
      }
    }
  }
  return product / square;
}

TEST(LandmarkBias, HasTheAskedSizePerAxisAndMoreAtTheTips) {
  auto rig = biased_rig("builtin:wave", 2);
  double all = 0, tips = 0, knuckles = 0;
  int count = 0;
  for (rig.twin.seed = 1; rig.twin.seed <= 60; ++rig.twin.seed) {
    const auto errors = errors_at(*twin_of(rig), 0.3);
    for (std::size_t i = 0; i < errors.size(); ++i) all += square_of(errors, {i}) / errors.size();
    tips += square_of(errors, {4, 8, 12, 16, 20});
    knuckles += square_of(errors, {1, 5, 9, 13, 17});
    ++count;
  }
  EXPECT_NEAR(std::sqrt(all / count), 2, 0.2);
  EXPECT_GT(std::sqrt(tips / knuckles), 1.3);
}

TEST(LandmarkBias, IsMoreAcrossTheFingersThanAlongThem) {
  auto rig = biased_rig("builtin:wave", 2);
  double along = 0, across = 0;
  for (rig.twin.seed = 1; rig.twin.seed <= 60; ++rig.twin.seed) {
    const auto twin = twin_of(rig);
    const auto truth = *twin->landmarks(Side::left, 0);
    const auto errors = errors_at(*twin, 0);
    for (const std::size_t tip : {8u, 12u, 16u, 20u}) {
      const glm::dvec2 bone = glm::normalize(glm::dvec2(truth[tip]) - glm::dvec2(truth[tip - 1]));
      along += std::pow(glm::dot(errors[tip], bone), 2);
      across += std::pow(bone.x * errors[tip].y - bone.y * errors[tip].x, 2);
    }
  }
  EXPECT_GT(std::sqrt(across / along), 1.3);
}

TEST(LandmarkBias, IsConstantOnAStillHand) {
  const auto twin = twin_of(biased_rig("builtin:still", 4));
  const auto first = errors_at(*twin, 0);
  EXPECT_GT(square_of(first, {4, 8, 12, 16, 20}), 1);
  for (const double t : {0.05, 0.4, 3.0, 20.0})
    for (std::size_t i = 0; i < first.size(); ++i)
      EXPECT_LT(glm::distance(errors_at(*twin, t)[i], first[i]), 0.15) << t;
}

constexpr std::array kRecordings{"translation", "rotation", "deformation", "all_5s"};

TEST(LandmarkBias, LastsForTheAskedTimeInHandsThatMoveAsInTheRecordings) {
  HANDCAST_NEEDS_RECORDINGS();
  for (const double bias_ms : {100.0, 200.0}) {  // longer ones outlast the gestures, which repeat
    double at_third = 0, at_time = 0, at_triple = 0;
    for (const char* name : {"rotation", "deformation"}) {  // 0.75 and 1.3 times the usual speed
      auto rig = biased_rig((outside_data() / "lmc" / name).string(), 3);
      rig.twin.detector.bias_ms = bias_ms;
      at_third += autocorrelation(rig, 0.3e-3 * bias_ms) / 2;
      at_time += autocorrelation(rig, 1e-3 * bias_ms) / 2;
      at_triple += autocorrelation(rig, 3e-3 * bias_ms) / 2;
    }
    EXPECT_GT(at_third, 0.65) << bias_ms;
    EXPECT_NEAR(at_time, 0.37, 0.2) << bias_ms << ": six people differ by some hundredths";
    EXPECT_LT(at_triple, 0.37) << bias_ms;
  }
}

TEST(LandmarkBias, TheUsualSpeedIsThatOfTheRecordings) {
  HANDCAST_NEEDS_RECORDINGS();
  double sum = 0;
  for (const char* name : kRecordings) {
    const auto twin = twin_of(rig_with((outside_data() / "lmc" / name).string()));
    std::vector<double> speeds;
    for (double t = 0.2; t < 4.5; t += 0.02) {
      const auto a = pose_numbers(camera_frames_at(*twin, t)),
                 b = pose_numbers(camera_frames_at(*twin, t + 0.02));
      double square = 0;
      for (std::size_t n = 0; n < a.size(); ++n) square += std::pow((b[n] - a[n]) / 0.02, 2);
      speeds.push_back(std::sqrt(square));
    }
    std::ranges::nth_element(speeds, speeds.begin() + std::ssize(speeds) / 2);
    sum += speeds[speeds.size() / 2];
  }
  EXPECT_NEAR(sum / kRecordings.size(), kUsualPoseSpeed, 0.1 * kUsualPoseSpeed);
}

TEST(LandmarkBias, IsLargerWhereTheHandHidesItsOwnLandmarks) {
  auto rig = biased_rig("builtin:fist", 2);
  double shut = 0, open = 0;
  for (rig.twin.seed = 1; rig.twin.seed <= 40; ++rig.twin.seed) {
    rig.twin.detector.bias_hidden = 1;
    const auto plain = twin_of(rig);
    rig.twin.detector.bias_hidden = 4;
    const auto twin = twin_of(rig);
    shut += square_of(errors_at(*twin, 0.9), {8, 12, 16}) /
            square_of(errors_at(*plain, 0.9), {8, 12, 16});
    open += square_of(errors_at(*twin, 0.1), {8, 12, 16}) /
            square_of(errors_at(*plain, 0.1), {8, 12, 16});
  }
  EXPECT_GT(std::sqrt(shut / 40), 2.5) << "behind the back of the hand";
  EXPECT_NEAR(std::sqrt(open / 40), 1, 0.05);
}

}  // namespace
}  // namespace handcast::twin
