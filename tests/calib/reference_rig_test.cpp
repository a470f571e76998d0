// SPDX-License-Identifier: Apache-2.0
// The calibration of the reference rig, beside what its authors published.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <vector>

#include "calib/calibration.hpp"
#include "tests/calib/calibration_files.hpp"

namespace handcast::calib {
namespace {

/// The bytes of a file of the calibration that the authors of the paper published; empty if the
/// external data is missing.
std::string published(const std::string& name) {
  const char* data = std::getenv("HANDCAST_DATA");
  const char* source = std::getenv("HANDCAST_SOURCE");
  const auto folder = data ? std::filesystem::path(data)
                           : std::filesystem::path(source ? source : ".") / "../shared/data";
  std::ifstream stream(folder / "calibration" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The numbers of the uncompressed array `name` (".npy") in a file. They start after the line of
/// its header.
template <class Number>
std::vector<Number> numbers_of(const std::string& bytes, const std::string& name,
                               std::size_t count) {
  const auto data = bytes.find('\n', bytes.find("\x93NUMPY", bytes.find(name))) + 1;
  std::vector<Number> numbers(count);
  std::memcpy(numbers.data(), bytes.data() + data, count * sizeof(Number));
  return numbers;
}

TEST(ReferenceRig, HasTheLensItsAuthorsPublished) {
  const auto bytes = published("cam_calibration.npz");
  if (bytes.empty())
    GTEST_SKIP()
        << "calibration/cam_calibration.npz is missing in ../shared/data or $HANDCAST_DATA";
  const auto lens = numbers_of<double>(bytes, "cam_distortion.npy", 5);
  const auto matrix = numbers_of<double>(bytes, "cam_intrinsics.npy", 9);
  const auto camera = reference_rig().camera;
  const double ours[] = {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(ours[i], lens[i], 1e-8) << i;
  EXPECT_LT(largest_difference(camera.matrix(), glm::transpose(glm::make_mat3(matrix.data()))),
            1e-3);
}

TEST(ReferenceRig, PlacesTheTrackerWhereItsAuthorsPublished) {
  const auto bytes = published("w2c.npy");
  if (bytes.empty())
    GTEST_SKIP() << "calibration/w2c.npy is missing in ../shared/data or $HANDCAST_DATA";
  // A camera as in OpenGL: y up, z backward, in mm.
  auto view = glm::dmat4(glm::make_mat4(numbers_of<float>(bytes, "", 16).data()));
  view[3] *= glm::dvec4(1e-3, 1e-3, 1e-3, 1);
  const glm::dmat4 flip(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
  EXPECT_LT(largest_difference(reference_rig().camera_from_tracker, flip * view), 1e-6);
}

TEST(ReferenceRig, PlacesTheTrackerByARightHandedRotation) {
  const auto transform = reference_rig().camera_from_tracker;
  const glm::dmat3 rotation(transform);
  EXPECT_NEAR(glm::determinant(rotation), 1, 1e-12);
  EXPECT_LT(largest_difference(rotation * glm::transpose(rotation), glm::dmat3(1)), 1e-12);
}

TEST(ReferenceRig, HasItsCameraWhereTheAuthorsMeasuredItInMetres) {
  const auto origin = glm::inverse(reference_rig().camera_from_tracker)[3];
  EXPECT_NEAR(origin.x, -0.0469, 1e-4);
  EXPECT_NEAR(origin.y, -0.1607, 1e-4);
  EXPECT_NEAR(origin.z, 0.4600, 1e-4);
}

TEST(ReferenceRig, SeesTheHandsPlaceInTheMiddleOfTheImage) {
  const auto rig = reference_rig();
  const auto hand = rig.camera_from_tracker * glm::dvec4(-0.06, 0.2, 0.01, 1);
  ASSERT_GT(hand.z, 0);
  const auto px = rig.camera.project(hand);
  EXPECT_GT(px.x, 0);
  EXPECT_LT(px.x, rig.camera.width_px);
}

TEST(ReferenceRig, CoversTheProjectorsPictureWithTheCamerasToTwoPercent) {
  const auto rig = reference_rig();
  const glm::dvec2 last(rig.projector.width_px - 1, rig.projector.height_px - 1);
  EXPECT_LT(glm::distance(rig.projector.pixel_of({359.5, 269.5}), last / 2.0), 1e-9);
  EXPECT_LT(glm::distance(rig.projector.pixel_of({-0.1, -0.1}), {0, 0}), 10);
  EXPECT_LT(glm::distance(rig.projector.pixel_of({719, 539}), last), 10);
}

TEST(ReferenceRig, HasATrueHomography) {
  const auto rig = reference_rig();
  const auto left = rig.projector.pixel_of({0, 269}), middle = rig.projector.pixel_of({359, 269}),
             right = rig.projector.pixel_of({718, 269});
  EXPECT_GT(std::abs(glm::distance(left, middle) - glm::distance(middle, right)), 0.5)
      << "no keystone";
  EXPECT_GT(std::abs(right.y - left.y), 3) << "not turned";
}

}  // namespace
}  // namespace handcast::calib
