// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

/// Has the tracker moved against the camera since the calibration? Still hands tell.
namespace handcast::calib {

/// Landmarks of a hand, in MediaPipe's order; 0 is the wrist, 9 the knuckle of the middle finger.
inline constexpr std::size_t kHandPoints = 21;

/// A joint of a hand in the tracker's space.
struct TrackedJoint {
  glm::dvec3 at_m{0};
  glm::dmat3 axes{1};  ///< tracker from joint
};
using TrackedHand = std::array<TrackedJoint, kHandPoints>;

/// A landmark in the camera's image.
struct SeenLandmark {
  glm::dvec2 undistorted_px{0};
  double sigma_px = 0;  ///< 0: not seen
};
using SeenHand = std::array<SeenLandmark, kHandPoints>;

/// A hand that was held still: what the tracker and the camera said of it at the same time, both as
/// the mean over that time.
struct HeldHand {
  std::int64_t time_ns = 0;
  TrackedHand tracked;
  SeenHand seen;
};

/// The mean place of all joints.
glm::dvec3 middle_of(const TrackedHand& hand);
/// The mean of hands at different times: of places; the axes are those of the middle one. `hands`
/// is not empty.
TrackedHand mean_of(const std::vector<TrackedHand>& hands);
/// The mean of the landmarks that were seen in at least half of the images.
SeenHand mean_of(const std::vector<SeenHand>& hands);
/// Root of the mean square distance of a hand's middle from its mean over time, and the same of
/// its joints, m.
struct Unrest {
  double middle_m = 0, joints_m = 0;
};
Unrest unrest_of(const std::vector<TrackedHand>& hands);

}  // namespace handcast::calib
