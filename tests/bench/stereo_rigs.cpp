// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stereo_rigs.hpp"

#include <cmath>

namespace handcast::bench {
namespace {

constexpr double kHands_m = 0.73;  ///< from the camera of the reference rig

glm::dmat4 shift(const glm::dvec3& by_m) {
  glm::dmat4 transform(1);
  transform[3] = glm::dvec4(by_m, 1);
  return transform;
}

/// From the space of a camera to that of one at `centre_m` whose axis meets its own at `far_m`.
glm::dmat4 turned_towards(double aside_m, double far_m) {
  const double length = std::hypot(aside_m, far_m);
  const glm::dvec3 z(-aside_m / length, 0, far_m / length), y(0, 1, 0), x = glm::cross(y, z);
  const glm::dmat4 turn(glm::transpose(glm::dmat3(x, y, z)));
  return turn * shift({-aside_m, 0, 0});
}

}  // namespace

StereoRig leap_rig() {
  constexpr double kApart_m = 0.04, kNearer_m = 0.45;
  StereoRig rig{"leap", calib::reference_rig(), 2, 115, 0, 0};
  auto& calibration = rig.calibration;
  calibration.camera_from_tracker =
      shift({kApart_m / 2, 0, -kNearer_m}) * calibration.camera_from_tracker;
  calibration.camera = {.width_px = 640,
                        .height_px = 480,
                        .fx_px = 260,
                        .fy_px = 260,
                        .cx_px = 319.5,
                        .cy_px = 239.5,
                        .k1 = -0.1,
                        .k2 = 0.01};
  calibration.camera2 = {{}, calibration.camera, shift({-kApart_m, 0, 0})};
  const double nearer = (kHands_m - kNearer_m) / kHands_m;
  rig.gain = 190 * nearer * nearer;
  return rig;
}

StereoRig gige_rig() {
  constexpr double kApart_m = 0.3;
  StereoRig rig{"gige", calib::reference_rig(), 1, 120, 3, 190};
  rig.calibration.camera2 = {{}, rig.calibration.camera, turned_towards(kApart_m, kHands_m)};
  return rig;
}

}  // namespace handcast::bench
