// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/tracker/tracker_hints.hpp"

#include <gtest/gtest.h>

#include "ipc/base/clock.hpp"

namespace handcast::landmarks {
namespace {

using namespace std::chrono_literals;

/// Every joint in one place, half a metre before the reference rig's camera and `right_m` beside
/// its axis.
msg::HandPoses poses_at(std::int64_t origin_ns, msg::Side side, double right_m) {
  const auto rig = calib::reference_rig();
  const glm::dvec3 place(glm::inverse(rig.camera_from_tracker) * glm::dvec4(right_m, 0, 0.5, 1));
  msg::HandPoses poses;
  poses.header.origin_ns = origin_ns;
  poses.count = 1;
  poses.hands[0].side = side;
  for (auto& joint : poses.hands[0].joints)
    joint.position_m = {static_cast<float>(place.x), static_cast<float>(place.y),
                        static_cast<float>(place.z)};
  return poses;
}

float x_px(const Hints& hints, msg::Side side) {
  const auto& hint = hints[static_cast<std::size_t>(side)];
  return hint ? (*hint)[9].x : -1;
}

TEST(TrackerHints, GoOnAsTheHandMovedUpToTheImagesTime) {
  TrackerHints tracker(first_camera(calib::reference_rig()));
  for (int i = 0; i <= 10; ++i)
    tracker.push(poses_at(to_ns(10ms) * i, msg::Side::right, 0.001 * i));
  const double centre = calib::reference_rig().camera.cx_px,
               px_per_mm = calib::reference_rig().camera.fx_px * 0.001 / 0.5;
  EXPECT_NEAR(x_px(tracker.at(to_ns(55ms)), msg::Side::right), centre + 5.5 * px_per_mm, 0.1);
  EXPECT_NEAR(x_px(tracker.at(to_ns(110ms)), msg::Side::right), centre + 11 * px_per_mm, 0.3);
  EXPECT_EQ(x_px(tracker.at(to_ns(110ms)), msg::Side::left), -1) << "no such hand";
}

TEST(TrackerHints, AreGoneSoonAfterTheHandIs) {
  TrackerHints tracker(first_camera(calib::reference_rig()));
  EXPECT_FALSE(tracker.at(0)[0]);
  tracker.push(poses_at(0, msg::Side::left, 0));
  EXPECT_TRUE(tracker.at(to_ns(90ms))[0]);
  EXPECT_FALSE(tracker.at(to_ns(120ms))[0]);
}

TEST(TrackerHints, AHandThatReachesTheCameraIsNotInItsImage) {
  msg::HandPoses poses = poses_at(0, msg::Side::left, 0);
  const glm::dvec3 near(glm::inverse(calib::reference_rig().camera_from_tracker) *
                        glm::dvec4(0, 0, 0.02, 1));
  poses.hands[0].joints[msg::kJointOfLandmark[20]].position_m = {
      static_cast<float>(near.x), static_cast<float>(near.y), static_cast<float>(near.z)};
  TrackerHints tracker(first_camera(calib::reference_rig()));
  tracker.push(poses);
  EXPECT_FALSE(tracker.at(0)[0]);
}

TEST(TrackerHints, TheLensIsPutOnAndTakenOff) {
  const auto camera = calib::reference_rig().camera;
  Points points{};
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {100 + 20 * static_cast<float>(i), 500 - 20 * static_cast<float>(i)};
  const Points back = undistorted(camera, distorted(camera, points));
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(glm::distance(back[i], points[i]), 0, 0.01);
}

}  // namespace
}  // namespace handcast::landmarks
