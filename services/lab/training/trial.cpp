// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/trial.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "ipc/base/clock.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::landmarks::training {
namespace {

using renderer::JointFrames;
using Joints = std::array<glm::vec3, msg::kLandmarks>;  // camera axes, metres

constexpr msg::Side kRecordedSide = msg::Side::left;  // the recordings are of left hands
constexpr std::uint64_t kPersonSeed = 500;            // whose hand a built-in motion moves

Joints joints_of(const JointFrames& frames) {
  Joints joints;
  for (int i = 0; i < msg::kLandmarks; ++i)
    joints[i] = glm::vec3(frames[msg::kJointOfLandmark[i]][3]);
  return joints;
}

glm::mat3 turn(Dice& dice, float deviation_rad) {
  const glm::vec3 axis =
      glm::normalize(glm::vec3(dice.normal(1), dice.normal(1), dice.normal(1)) + 1e-6f);
  return glm::mat3(glm::rotate(glm::mat4(1), dice.normal(deviation_rad), axis));
}

/// Adds a tracker's errors in space: joints bent about any axis, the hand turned and of another
/// size. This is not the model of the training.
void disturb(Dice& dice, Joints& joints) {
  for (int finger = 0; finger < 5; ++finger)
    for (int k = 1; k < 4; ++k) {
      const glm::vec3 root = joints[4 * finger + k];
      const glm::mat3 bent = turn(dice, 0.2f);
      for (int j = k + 1; j <= 4; ++j)
        joints[4 * finger + j] = root + bent * (joints[4 * finger + j] - root);
    }
  const glm::mat3 whole = turn(dice, 0.12f) * std::exp(dice.normal(0.07f));
  for (int i = 1; i < msg::kLandmarks; ++i) joints[i] = joints[0] + whole * (joints[i] - joints[0]);
}

std::array<bool, 5> folded_of(const Joints& joints) {
  std::array<bool, 5> folded;
  for (int finger = 0; finger < 5; ++finger) {
    float length = 0;
    for (int k = 1; k < 4; ++k)
      length += glm::distance(joints[4 * finger + k], joints[4 * finger + k + 1]);
    folded[finger] = glm::distance(joints[4 * finger + 1], joints[4 * finger + 4]) < 0.8f * length;
  }
  return folded;
}

}  // namespace

static Result<double> duration_of(const std::string& motion) {
  constexpr double kBuiltin_s = 4.8;  // most of each motion
  if (motion.starts_with("builtin:")) return kBuiltin_s;
  const auto recording = recording::read_recording(motion);
  if (!recording) return tl::make_unexpected(recording.error());
  return ns_to_seconds(recording->time_ns.back());
}

/// The flesh of a careful installation (docs/method.md#twin).
static config::TwinShape flesh_of_others(const std::string& mesh) {
  config::TwinShape shape;
  shape.mesh = mesh;
  shape.bone_width_spread = shape.thickness_spread = shape.taper_spread = 0.08;
  shape.roll_deg = 7;
  shape.skinning = config::TwinSkinning::dual_quaternion;
  shape.bulge = 0.15;
  return shape;
}

Result<Trials> Trials::open(const std::string& motion, std::uint64_t seed,
                            const std::string& mesh) {
  const auto duration_s = duration_of(motion);
  if (!duration_s) return tl::make_unexpected(duration_s.error());
  config::Rig rig;
  rig.twin.motion = motion;
  rig.twin.seed = static_cast<int>(kPersonSeed + seed);
  if (mesh != config::TwinShape{}.mesh) rig.twin.shape = flesh_of_others(mesh);
  const calib::Calibration calibration = calib::reference_rig();
  auto world = twin::Twin::create(rig, calibration);
  if (!world) return tl::make_unexpected(world.error());
  Trials trials(std::move(*world), calibration, seed);
  trials.duration_s_ = *duration_s;
  return trials;
}

std::uint64_t Trials::frame(int i, int count) const {
  const double seconds = duration_s_ * (i + 0.5) / count;
  return static_cast<std::uint64_t>(seconds / ns_to_seconds(twin_->camera_origin_ns(1000)) * 1000);
}

std::optional<JointFrames> Trials::in_camera(int i, int count) const {
  auto joints = twin_->joints(kRecordedSide, twin_->camera_origin_ns(frame(i, count)));
  if (joints)
    for (auto& joint : *joints) joint = glm::mat4(calibration_.camera_from_tracker) * joint;
  return joints;
}

Points Trials::image_px(const JointFrames& frames) const {
  Points points_px;
  const Joints joints = joints_of(frames);
  for (std::size_t i = 0; i < joints.size(); ++i)
    points_px[i] = calibration_.camera.distort(calibration_.camera.project(joints[i]));
  return points_px;
}

std::optional<Trial> Trials::make(int i, int count) {
  Trial trial{.image = {calibration_.camera.width_px, calibration_.camera.height_px},
              .side = kRecordedSide};
  const auto now = in_camera(i, count);
  if (!now) return std::nullopt;
  twin_->camera_image(frame(i, count), trial.image.view());
  trial.truth_px = image_px(*now);
  trial.folded = folded_of(joints_of(*now));

  Dice dice(seed_, static_cast<std::uint64_t>(i));
  const float shift_px = 0.14f * palm_length_px(trial.truth_px);
  const auto tracked = [&](Joints joints) {
    disturb(dice, joints);
    const glm::vec2 by(dice.normal(shift_px), dice.normal(shift_px));
    Points points_px;
    for (std::size_t k = 0; k < joints.size(); ++k)
      points_px[k] =
          glm::vec2(calibration_.camera.distort(calibration_.camera.project(joints[k]))) + by;
    return points_px;
  };
  trial.tracker_px = tracked(joints_of(*now));
  const auto other = in_camera((i + count / 5 + dice.pick(count / 2)) % count, count);
  const JointFrames& pose = other ? *other : *now;
  const glm::mat4 onto_now = (*now)[1] * glm::inverse(pose[1]);
  JointFrames wrong;
  for (std::size_t j = 0; j < wrong.size(); ++j) wrong[j] = onto_now * pose[j];
  trial.other_pose_px = tracked(joints_of(wrong));
  return trial;
}

}  // namespace handcast::landmarks::training
