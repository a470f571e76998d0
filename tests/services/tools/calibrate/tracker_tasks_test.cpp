// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/tracker_tasks.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "services/recording/arrays/npy.hpp"

namespace handcast::calibrate {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

class Points : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const char* name, std::vector<std::size_t> shape, std::vector<float> values) const {
    ASSERT_TRUE(recording::write_npy_f32(folder_ / name, shape, values));
  }
  std::string refusal() const {
    const auto points = read_points(folder_, camera_);
    return points ? "" : points.error().what;
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("handcast-points-" + std::to_string(getpid()));
  const calib::CameraModel camera_ = calib::reference_rig().camera;
};

TEST_F(Points, AreReadWithTheirTimes) {
  write("2dpoints.npy", {2, 2}, {10, 20, 30, 40});
  write("3dpoints.npy", {2, 3}, {1, 2, 3, 4, 5, 6});
  const auto without_times = read_points(folder_, camera_);
  ASSERT_TRUE(without_times) << without_times.error().what;
  EXPECT_EQ(without_times->sightings[1].time_ns, 10'000'000);
  EXPECT_NEAR(without_times->samples[1].points_m[0].z, 0.006, 1e-9);
  EXPECT_LT(glm::distance(camera_.distort(without_times->sightings[0].undistorted_px),
                          glm::dvec2(10, 20)),
            1e-3);
  ASSERT_TRUE(recording::write_npy_i64(folder_ / "timestamps.npy", {5'000'000, 5'025'000}));
  EXPECT_EQ(read_points(folder_, camera_)->samples[1].time_ns, 25'000'000);
}

TEST_F(Points, ThatDoNotBelongTogetherAreRefusedInASentence) {
  EXPECT_THAT(refusal(), HasSubstr("2dpoints.npy"));
  write("2dpoints.npy", {2, 2}, {10, 20, 30, 40});
  EXPECT_THAT(refusal(), HasSubstr("3dpoints.npy"));
  write("3dpoints.npy", {3, 3}, std::vector<float>(9));
  EXPECT_THAT(refusal(), HasSubstr("2 points in the image and 3 in space"));
  write("3dpoints.npy", {3, 2}, std::vector<float>(6));
  EXPECT_THAT(refusal(), HasSubstr("n rows of 3 numbers"));
  write("3dpoints.npy", {2, 3}, std::vector<float>(6));
  ASSERT_TRUE(recording::write_npy_i64(folder_ / "timestamps.npy", {1, 2, 3}));
  EXPECT_THAT(refusal(), HasSubstr("3 times of 2 points"));
  write("timestamps.npy", {2}, {0, INFINITY});
  EXPECT_THAT(refusal(), HasSubstr("not within two hours"));
  std::ofstream(folder_ / "2dpoints.npy") << "no array";
  EXPECT_THAT(refusal(), HasSubstr("2dpoints.npy"));
}

// The points of the paper's authors.
TEST_F(Points, OfTheAuthorsAreCalledPoorWithTheSpreadThatTheyAllow) {
  const char* data = std::getenv("HANDCAST_DATA");
  const auto real = fs::path(data ? data : "../shared/data") / "calibration";
  if (!fs::exists(real / "3dpoints.npy"))
    GTEST_SKIP() << "no points in " << real << "; HANDCAST_DATA names another folder";
  const auto points = read_points(real, camera_);
  ASSERT_TRUE(points) << points.error().what;
  const auto fit = calib::fit_tracker(camera_, points->samples, points->sightings);
  ASSERT_TRUE(fit) << fit.error().what;
  const auto lines = describe_points(*fit);
  EXPECT_THAT(lines[0], HasSubstr("These points are poor"));
  EXPECT_THAT(lines[1], HasSubstr("They allow a camera at"));
  EXPECT_GT(fit->camera_place_mm[2].high, 15);
  EXPECT_THAT(lines, Contains(HasSubstr("The first 9.3 s do not fit")));
  EXPECT_THAT(lines, Contains(HasSubstr("The camera's place is known only to")));
  const auto judged = judge_points(real, camera_);
  ASSERT_FALSE(judged);
  EXPECT_EQ(judged.error().code, Errc::bad_data);
}

}  // namespace
}  // namespace handcast::calibrate
