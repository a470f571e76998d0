// SPDX-License-Identifier: Apache-2.0
// The points of the paper's authors: a reflector on a finger tip, seen by the tracker and the
// camera. They are not in the repository.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "calib/solve/tracker/fit_tracker.hpp"

namespace handcast::calib {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// HANDCAST_DATA or ../shared/data.
std::filesystem::path folder() {
  const char* data = std::getenv("HANDCAST_DATA");
  return std::filesystem::path(data ? data : "../shared/data") / "calibration";
}

/// The numbers of a .npy file of float32 whose header has the length of format 1.0.
std::vector<float> read_f32(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  constexpr std::size_t kPreamble = 10;
  if (bytes.size() < kPreamble) return {};
  const auto header = kPreamble + static_cast<unsigned char>(bytes[8]) +
                      256 * static_cast<std::size_t>(static_cast<unsigned char>(bytes[9]));
  std::vector<float> values((bytes.size() - header) / sizeof(float));
  std::memcpy(values.data(), bytes.data() + header, values.size() * sizeof(float));
  return values;
}

/// The points have no times: the rows count as samples at 100 Hz.
struct RealPoints {
  std::vector<TrackerSample> samples;
  std::vector<Sighting> sightings;
};

RealPoints read_points(const CameraModel& camera, bool undistort) {
  constexpr std::int64_t kStep_ns = 10'000'000;
  const auto mm = read_f32(folder() / "3dpoints.npy"), px = read_f32(folder() / "2dpoints.npy");
  RealPoints points;
  for (std::size_t i = 0; i < px.size() / 2; ++i) {
    const auto time_ns = static_cast<std::int64_t>(i) * kStep_ns;
    points.samples.push_back(
        {time_ns, {glm::dvec3(mm[3 * i], mm[3 * i + 1], mm[3 * i + 2]) / 1000.}});
    const glm::dvec2 at(px[2 * i], px[2 * i + 1]);
    points.sightings.push_back({time_ns, 0, undistort ? camera.undistort(at) : at, 1});
  }
  return points;
}

class RealPointsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder() / "3dpoints.npy"))
      GTEST_SKIP() << "no points in " << folder() << "; HANDCAST_DATA names another folder";
  }
  const Calibration published_ = reference_rig();
};

/// The published place of the camera minus the estimate, along the camera's axes.
glm::dvec3 off_by_mm(const Calibration& published, const TrackerFit& fit) {
  const auto there = fit.camera_from_tracker * glm::inverse(published.camera_from_tracker)[3];
  return 1000. * glm::dvec3(there);
}

// The noise of this set, 8 px, hides whether its pixels are distorted (which moves them by 2 px at
// most): both readings fit equally well.
TEST_F(RealPointsTest, APoorSetIsCalledPoorWithTheReasons) {
  for (const bool undistort : {false, true}) {
    const auto points = read_points(published_.camera, undistort);
    ASSERT_EQ(points.samples.size(), 10000U);
    const auto fit = fit_tracker(published_.camera, points.samples, points.sightings);
    ASSERT_TRUE(fit) << fit.error().what;
    EXPECT_EQ(fit->quality, Quality::poor);
    EXPECT_THAT(fit->findings.front(), HasSubstr("The camera's place is known only to"));
    EXPECT_THAT(fit->findings, Contains(HasSubstr("outliers are judged more or less strictly")));
    EXPECT_THAT(fit->findings, Contains(HasSubstr("The first 9.3 s do not fit")));
    EXPECT_THAT(fit->findings, Contains(HasSubstr("do not see the same points")));
  }
}

// The published place was estimated from the same camera and tracker, and is not exact either.
TEST_F(RealPointsTest, TheIntervalAllowsCentimetresAndThePublishedPlaceIsNear) {
  const auto points = read_points(published_.camera, true);
  const auto fit = fit_tracker(published_.camera, points.samples, points.sightings);
  ASSERT_TRUE(fit) << fit.error().what;
  const auto off_mm = off_by_mm(published_, *fit);
  for (int axis = 0; axis < 3; ++axis) {
    const auto& place = fit->camera_place_mm[static_cast<std::size_t>(axis)];
    EXPECT_GT(place.high - place.low, 30);
    EXPECT_LT(std::abs(off_mm[axis]), 1.5 * place.high) << "axis " << axis;
  }
}

}  // namespace
}  // namespace handcast::calib
