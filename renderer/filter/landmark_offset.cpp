// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/landmark_offset.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/clock.hpp"
#include "renderer/base/joint_math.hpp"

namespace handcast::renderer {
namespace {

constexpr double kPrior_m = 0.004;
constexpr double kLeastSigma_px = 5;  ///< of a landmark: what lasts is more than its sigma
constexpr double kFarFromLearned_px =
    8;                              ///< offsets farther than this from the learned one count less
constexpr double kLasting_s = 0.4;  ///< errors of landmarks are independent after this
constexpr double kMemory_s = 20;
constexpr double kMost_m = 0.025;
/// Sum of the flexion of a finger's joints at which it begins to teach less, and teaches nothing.
constexpr double kFolding_rad = 1.2, kFolded_rad = 2.4;
constexpr double kNearest_m = 0.05;

/// One joint as the camera sees it.
struct SeenJoint {
  bool is_in_front = false;  ///< of the camera
  glm::dvec2 at_px{0};
  glm::dmat3x2 jacobian_px_per_m{0};  ///< of at_px by a displacement in the frame of the joint
};

SeenJoint see(const calib::Calibration& calibration, const msg::Joint& joint) {
  const glm::dvec3 at(calibration.camera_from_tracker * glm::dvec4(position(joint), 1));
  if (!(at.z > kNearest_m)) return {};
  const glm::dmat3 camera_from_joint =
      glm::dmat3(calibration.camera_from_tracker) * glm::mat3_cast(glm::dquat(orientation(joint)));
  return {true, calibration.camera.project(at),
          calibration.camera.jacobian_px_per_m(at) * camera_from_joint};
}

/// The direction of the bone that begins at a joint.
glm::dvec3 towards_tip(const msg::HandPose& pose, int joint) {
  return glm::dquat(orientation(pose.joints[static_cast<std::size_t>(joint)])) *
         glm::dvec3(0, 0, -1);
}

/// How far the tracker sees a landmark: 1, and less for those beyond the knuckle of a finger that
/// is folded. Trackers guess such fingers, with errors that last for seconds.
double seen_share(const msg::HandPose& pose, int landmark) {
  const int part = (landmark - 1) % 4, knuckle = landmark - part;
  if (landmark < 5 || part == 0) return 1;
  double flexion_rad = 0;
  for (int i = knuckle; i < knuckle + 3; ++i) {
    const int joint = msg::kJointOfLandmark[static_cast<std::size_t>(i)];
    const double cosine = glm::dot(towards_tip(pose, joint - 1), towards_tip(pose, joint));
    flexion_rad += std::acos(std::clamp(cosine, -1.0, 1.0));
  }
  return 1 - glm::smoothstep(kFolding_rad, kFolded_rad, flexion_rad);
}

/// What is left of the offset of a landmark, and its weight.
struct Offset {
  glm::dvec2 at_px{0}, left_px{0};
  double weight = 0;  ///< 1/px^2; 0: not seen
};
using Offsets = std::array<Offset, msg::kLandmarks>;

/// What a displacement of the joint leaves of the way from the tracker's joint to its landmark,
/// with a share of the weight that the landmark's sigma gives it.
Offset offset_of(const SeenJoint& joint, const msg::Landmark& landmark, glm::dvec3 displacement_m,
                 double share) {
  const double sigma_px = std::hypot(kLeastSigma_px, landmark.sigma_px);
  if (!joint.is_in_front || !(landmark.confidence > 0) ||
      !std::isfinite(landmark.x_px + landmark.y_px + sigma_px))
    return {};
  const glm::dvec2 way_px = glm::dvec2(landmark.x_px, landmark.y_px) - joint.at_px;
  return {joint.at_px, way_px - joint.jacobian_px_per_m * displacement_m,
          share / (sigma_px * sigma_px)};
}

/// The shift, turn and scale in the image that all offsets share.
struct Shared {
  glm::dvec2 centre_px{0}, shift_px{0};
  double scale = 0, turn = 0;

  glm::dvec2 at(glm::dvec2 at_px) const {
    const glm::dvec2 way = at_px - centre_px;
    return shift_px + glm::dvec2(scale * way.x - turn * way.y, turn * way.x + scale * way.y);
  }
};

/// Less weight for offsets far from what all share.
double weight_of(const Offset& offset, const Shared& shared) {
  const double far = glm::length(offset.left_px - shared.at(offset.at_px)) / kFarFromLearned_px;
  return offset.weight / (1 + far * far);
}

Shared shared_by(const Offsets& offsets, const Shared& guess) {
  Shared shared;
  double sum = 0, spread = 1e-9;
  for (const Offset& offset : offsets) {
    const double weight = weight_of(offset, guess);
    sum += weight;
    shared.centre_px += weight * offset.at_px;
    shared.shift_px += weight * offset.left_px;
  }
  if (!(sum > 0)) return {};
  shared.centre_px /= sum;
  shared.shift_px /= sum;
  for (const Offset& offset : offsets) {
    const glm::dvec2 way = offset.at_px - shared.centre_px, by = offset.left_px - shared.shift_px;
    const double weight = weight_of(offset, guess);
    shared.scale += weight * glm::dot(way, by);
    shared.turn += weight * (way.x * by.y - way.y * by.x);
    spread += weight * glm::dot(way, way);
  }
  shared.scale /= spread;
  shared.turn /= spread;
  return shared;
}

/// The median of the offsets, along each axis.
Shared median_of(const Offsets& offsets) {
  Shared median;
  for (int axis = 0; axis < 2; ++axis) {
    std::array<double, msg::kLandmarks> values{};
    auto* end = values.begin();
    for (const Offset& offset : offsets)
      if (offset.weight > 0) *end++ = offset.left_px[axis];
    if (end == values.begin()) return median;
    auto* const middle = values.begin() + (end - values.begin()) / 2;
    std::nth_element(values.begin(), middle, end);
    median.shift_px[axis] = *middle;
  }
  return median;
}

}  // namespace

void LandmarkOffset::learn(std::int64_t origin_ns, const msg::HandPose& pose,
                           const msg::HandLandmarks& seen) {
  const double since_s = std::clamp(ns_to_seconds(origin_ns - last_ns_), 0.0, kLasting_s);
  last_ns_ = origin_ns;
  std::array<SeenJoint, msg::kLandmarks> joints;
  Offsets offsets;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] = see(calibration_, pose.joints[static_cast<std::size_t>(msg::kJointOfLandmark[i])]);
    offsets[i] = offset_of(joints[i], seen.points[i], learned_[i].displacement_m,
                           seen_share(pose, static_cast<int>(i)));
  }
  // What all landmarks of this image share is not of the joints.
  const Shared shared = shared_by(offsets, shared_by(offsets, median_of(offsets)));
  const double keep = std::exp(-since_s / kMemory_s), share = since_s / kLasting_s;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    learned_[i].information *= keep;
    learned_[i].weighted *= keep;
    if (!joints[i].is_in_front) continue;
    add(joints[i].jacobian_px_per_m, offsets[i].left_px - shared.at(offsets[i].at_px),
        share * weight_of(offsets[i], shared), learned_[i]);
  }
}

void LandmarkOffset::add(const glm::dmat3x2& jacobian_px_per_m, glm::dvec2 left_px, double weight,
                         Learned& learned) {
  if (weight > 0) {
    const glm::dmat2x3 transposed = glm::transpose(jacobian_px_per_m);
    const glm::dvec2 own_px = left_px + jacobian_px_per_m * learned.displacement_m;
    learned.information += weight * (transposed * jacobian_px_per_m);
    learned.weighted += weight * (transposed * own_px);
    const glm::dmat3 prior(1 / (kPrior_m * kPrior_m));
    learned.displacement_m = glm::inverse(learned.information + prior) * learned.weighted;
    if (const double length = glm::length(learned.displacement_m); length > kMost_m)
      learned.displacement_m *= kMost_m / length;
  }
  learned.displacement_px = jacobian_px_per_m * learned.displacement_m;
}

msg::HandLandmarks LandmarkOffset::as_tracked(const msg::HandLandmarks& seen) const {
  msg::HandLandmarks result = seen;
  for (std::size_t i = 0; i < learned_.size(); ++i) {
    result.points[i].x_px -= static_cast<float>(learned_[i].displacement_px.x);
    result.points[i].y_px -= static_cast<float>(learned_[i].displacement_px.y);
  }
  return result;
}

}  // namespace handcast::renderer
