// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/orientation_bias.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/clock.hpp"
#include "renderer/base/joint_math.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {
namespace {

/// The landmarks that detectors and trackers define alike: the outer two joints of each finger.
constexpr std::array kDefinedAlike{3, 4, 7, 8, 11, 12, 15, 16, 19, 20};
constexpr int kWristJoint = 1;
constexpr int kShared = 4;              ///< shift, scale and roll, which differ from image to image
constexpr int kUnknowns = kShared + 2;  ///< and the turns about the image's axes
constexpr double kLeastSigma_px = 5;    ///< of a landmark: what lasts is more than its sigma
constexpr double kLasting_s = 0.4;      ///< errors of landmarks are independent after this
constexpr double kMemory_s = 10;
constexpr double kPrior_rad = 0.05;
constexpr double kMostBias_rad = 0.2;
constexpr double kNearestHand_m = 0.05;

using Row = std::array<double, kUnknowns>;
using Normal = std::array<Row, kUnknowns>;

glm::dvec3 at(const msg::HandPose& pose, int joint) {
  return position(pose.joints[static_cast<std::size_t>(joint)]);
}

/// Eliminates the first kShared unknowns: what remains, their Schur complement, are the normal
/// equations of the others. False if they are not determined.
bool eliminate_shared(Normal& normal, Row& right) {
  for (int k = 0; k < kShared; ++k) {
    if (!(normal[k][k] > 1e-9)) return false;
    for (int i = k + 1; i < kUnknowns; ++i) {
      const double share = normal[i][k] / normal[k][k];
      for (int j = k; j < kUnknowns; ++j) normal[i][j] -= share * normal[k][j];
      right[i] -= share * right[k];
    }
  }
  return true;
}

}  // namespace

void OrientationBias::learn(std::int64_t origin_ns, const msg::HandPose& pose,
                            const msg::HandLandmarks& seen) {
  const double since_s = std::clamp(ns_to_seconds(origin_ns - last_ns_), 0.0, kLasting_s);
  last_ns_ = origin_ns;
  const auto in_camera = [&](int joint) {
    return glm::dvec3(calibration_.camera_from_tracker * glm::dvec4(at(pose, joint), 1));
  };
  const glm::dvec3 wrist = in_camera(kWristJoint);
  const auto& camera = calibration_.camera;
  Normal normal{};
  Row right{};
  for (const int i : kDefinedAlike) {
    const glm::dvec3 joint = in_camera(msg::kJointOfLandmark[i]);
    const auto& point = seen.points[i];
    if (!was_seen(point) || !(joint.z > kNearestHand_m) || !(wrist.z > kNearestHand_m)) continue;
    const glm::dvec2 from = camera.project(joint), way = from - camera.project(wrist),
                     offset = glm::dvec2(point.x_px, point.y_px) - from;
    const double sigma = std::hypot(kLeastSigma_px, point.sigma_px), weight = 1 / (sigma * sigma);
    // The displacement in the image by a small turn: of the cross product with `arm`, and of the
    // change of depth.
    const glm::dvec3 arm = (joint - wrist) / joint.z;
    const glm::dvec2 ray = from - glm::dvec2(camera.cx_px, camera.cy_px);
    const std::array<Row, 2> rows{
        Row{1, 0, way.x, -way.y, -ray.x * arm.y, camera.fx_px * arm.z + ray.x * arm.x},
        Row{0, 1, way.y, way.x, -camera.fy_px * arm.z - ray.y * arm.y, ray.y * arm.x}};
    for (int axis = 0; axis < 2; ++axis)
      for (int a = 0; a < kUnknowns; ++a) {
        for (int b = 0; b < kUnknowns; ++b) normal[a][b] += weight * rows[axis][a] * rows[axis][b];
        right[a] += weight * rows[axis][a] * offset[axis];
      }
  }
  // What is not a number would stay in the sums for ever.
  if (!eliminate_shared(normal, right) || !std::isfinite(right[kShared] + right[kShared + 1]))
    return;
  const double keep = std::exp(-since_s / kMemory_s), share = since_s / kLasting_s;
  information_ *= keep;
  weighted_ *= keep;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) information_[a][b] += share * normal[kShared + a][kShared + b];
    weighted_[a] += share * right[kShared + a];
  }
  const glm::dmat3 prior(1 / (kPrior_rad * kPrior_rad));
  angle_rad_ = glm::inverse(information_ + prior) * weighted_;
  if (!(glm::length(angle_rad_) < kMostBias_rad))
    angle_rad_ *= kMostBias_rad / glm::length(angle_rad_);
}

msg::HandPose OrientationBias::turned(const msg::HandPose& pose) const {
  const double angle = glm::length(angle_rad_);
  if (!(angle > 1e-6)) return pose;
  const glm::dmat3 tracker_from_camera =
      glm::transpose(glm::dmat3(calibration_.camera_from_tracker));
  const glm::dmat3 turn(
      glm::rotate(glm::dmat4(1), angle, tracker_from_camera * (angle_rad_ / angle)));
  const glm::quat quaternion(glm::quat_cast(turn));
  const glm::dvec3 wrist = at(pose, kWristJoint);
  msg::HandPose result = pose;
  for (int j = 0; j < msg::kJoints; ++j) {
    auto& joint = result.joints[static_cast<std::size_t>(j)];
    place(joint, glm::vec3(wrist + turn * (at(pose, j) - wrist)), quaternion * orientation(joint));
  }
  return result;
}

}  // namespace handcast::renderer
