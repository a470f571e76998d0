// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/twin/twin.hpp"

#include <cmath>
#include <future>
#include <mutex>
#include <optional>

#include "ipc/base/clock.hpp"
#include "renderer/skin/skinning.hpp"
#include "services/evaluation/twin/camera_scene.hpp"
#include "services/evaluation/twin/camera_times.hpp"
#include "services/evaluation/twin/detector.hpp"
#include "services/evaluation/twin/tracker.hpp"

namespace handcast::twin {
namespace {

constexpr std::array<Side, 2> kSides{Side::left, Side::right};

struct Parts {
  std::unique_ptr<Motion> motion;
  std::array<renderer::HandMesh, 2> models;
  std::array<bool, 2> made_by_handcast{};
};

renderer::JointFrames rest_of(Side side, const renderer::HandShape& person) {
  renderer::JointFrames rest = renderer::rest_frames(person);
  if (side == Side::left) return rest;
  for (auto& frame : rest)
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r)
        if ((c == 0) != (r == 0)) frame[c][r] = -frame[c][r];
  return rest;
}

/// The model's surface on the true person's bones. A hand made by handcast is made again for the
/// person; any other model is posed by its own skin weights.
renderer::HandMesh true_hand_of(const renderer::HandMesh& model, bool made_by_handcast,
                                const renderer::HandShape& person) {
  if (made_by_handcast) return renderer::refit_hand(model, person);
  renderer::HandMesh hand = model;
  const renderer::JointFrames rest = rest_of(model.side, person);
  renderer::skin(model, rest, hand.positions, hand.normals);
  hand.rest = rest;
  return hand;
}

/// The surfaces of the true hands. They take a quarter of a second to make and are therefore made
/// on first use: the camera and the judge need them, the tracker and the detector do not.
class TrueHands {
 public:
  TrueHands(std::array<renderer::HandMesh, 2> models, std::array<bool, 2> made_by_handcast,
            std::array<bool, 2> seen, const renderer::HandShape& person)
      : hands_(std::move(models)),
        made_by_handcast_(made_by_handcast),
        seen_(seen),
        person_(person) {}

  const renderer::HandMesh& of(Side side) const {
    std::call_once(made_, [this] {
      auto left = std::async(std::launch::async, [this] { make(Side::left); });
      make(Side::right);
    });
    return hands_[static_cast<std::size_t>(side)];
  }

 private:
  void make(Side side) const {
    const auto i = static_cast<std::size_t>(side);
    if (seen_[i]) hands_[i] = true_hand_of(hands_[i], made_by_handcast_[i], person_);
  }

  mutable std::once_flag made_;
  mutable std::array<renderer::HandMesh, 2> hands_;  ///< the models until the first use
  std::array<bool, 2> made_by_handcast_, seen_;
  renderer::HandShape person_;
};

class RigTwin final : public Twin {
 public:
  RigTwin(const config::Rig& rig, const calib::Calibration& calibration, Parts parts)
      : calibration_(calibration),
        exposure_ns_(ms_to_ns(rig.camera.exposure_ms)),
        camera_(rig),
        absent_(rig.twin.hands == config::TwinHands::left    ? std::optional(Side::right)
                : rig.twin.hands == config::TwinHands::right ? std::optional(Side::left)
                                                             : std::nullopt),
        motion_(std::move(parts.motion)),
        hands_(std::move(parts.models), parts.made_by_handcast,
               {moves(Side::left), moves(Side::right)}, motion_->shape()),
        tracker_(rig.twin.tracker, rig.twin.seed, calibration, motion_->shape()),
        detector_(rig.twin.detector, rig.twin.seed, calibration.camera, motion_->shape()),
        image_(rig.twin.image),
        seed_(rig.twin.seed) {}

  std::optional<JointFrames> joints(Side side, std::int64_t time_ns) const override {
    return side == absent_ ? std::nullopt : motion_->at(side, ns_to_seconds(time_ns));
  }

  const renderer::HandMesh& true_hand(Side side) const override { return hands_.of(side); }

  std::optional<std::array<glm::vec2, msg::kLandmarks>> landmarks(
      Side side, std::int64_t time_ns) const override {
    const auto truth = joints(side, time_ns);
    if (!truth) return std::nullopt;
    std::array<glm::vec2, msg::kLandmarks> points;
    for (int i = 0; i < msg::kLandmarks; ++i) {
      const glm::dvec4 place((*truth)[msg::kJointOfLandmark[i]][3]);
      points[i] = calibration_.camera.project(glm::dvec3(calibration_.camera_from_tracker * place));
    }
    return points;
  }

  TrackerSample tracker_sample(std::uint64_t k) const override {
    TrackerSample sample;
    sample.arrival_ns = tracker_.arrival_ns(k);
    sample.poses.header = {k, tracker_.stamp_ns(k), sample.arrival_ns};
    if (tracker_.lost(k)) return sample;
    for (const Side side : kSides)
      if (const auto pose = tracker_.report(
              k, side, [&](std::int64_t time_ns) { return joints(side, time_ns); })) {
        auto& hand = sample.poses.hands[sample.poses.count++];
        hand = *pose;
        if (!tracker_.knows_sides(k)) hand.side = side == Side::left ? Side::right : Side::left;
      }
    return sample;
  }

  std::int64_t tracker_time_ns(std::uint64_t k) const override { return tracker_.sample_ns(k); }

  std::int64_t camera_origin_ns(std::uint64_t k) const override { return camera_.origin_ns(k); }
  std::int64_t camera_stamp_ns(std::uint64_t k) const override { return camera_.stamp_ns(k); }
  bool camera_lost(std::uint64_t k) const override { return camera_.lost(k); }
  std::int64_t camera_arrival_ns(std::uint64_t k) const override { return camera_.arrival_ns(k); }

  void camera_image(std::uint64_t k, renderer::View<std::uint8_t> image) const override {
    const auto truth = [this](Side side, std::int64_t time_ns) { return joints(side, time_ns); };
    scene().draw(k, camera_origin_ns(k), exposure_ns_, truth, image);
  }

  Detection detect(std::uint64_t n, std::uint64_t frame_id, std::int64_t stamp_ns) const override {
    const std::int64_t origin_ns = camera_.true_ns(frame_id, stamp_ns);
    Detection detection;
    detection.age_ns = detector_.age_ns(n);
    detection.landmarks.header = {frame_id, detector_.stamp_ns(stamp_ns),
                                  origin_ns + detection.age_ns};
    if (detector_.lost(n, origin_ns)) return detection;
    for (const Side side : kSides) {
      const auto truth = landmarks(side, origin_ns);
      if (truth)
        detection.landmarks.hands[detection.landmarks.count++] =
            detector_.report(n, side, *truth, in_camera(*joints(side, origin_ns)), origin_ns);
    }
    return detection;
  }

 private:
  JointFrames in_camera(JointFrames frames) const {
    for (auto& frame : frames)
      frame = glm::mat4(calibration_.camera_from_tracker * glm::dmat4(frame));
    return frames;
  }

  bool moves(Side side) const { return motion_->at(side, 0).has_value(); }

  CameraScene& scene() const {
    if (scene_) return *scene_;
    scene_.emplace(image_, seed_, calibration_);
    for (const Side side : kSides) scene_->set_hand(side, true_hand(side));
    return *scene_;
  }

  calib::Calibration calibration_;
  std::int64_t exposure_ns_;
  CameraTimes camera_;
  std::optional<Side> absent_;  ///< the hand of the motion that is left out
  std::unique_ptr<Motion> motion_;
  TrueHands hands_;
  TrackerModel tracker_;
  DetectorModel detector_;
  config::TwinImage image_;
  int seed_;
  mutable std::optional<CameraScene> scene_;  ///< made for the first image
};

}  // namespace

Result<std::unique_ptr<Twin>> Twin::create(const config::Rig& rig,
                                           const calib::Calibration& calibration) {
  auto motion = open_motion(rig.twin, calibration);
  if (!motion) return tl::make_unexpected(motion.error());
  Parts parts{.motion = std::move(*motion), .models = {}};
  for (const Side side : kSides) {
    const std::filesystem::path file = side == Side::left ? rig.hand.left : rig.hand.right;
    auto model = renderer::load_hand_or_default(file, side);
    if (!model) return tl::make_unexpected(model.error());
    parts.models[static_cast<std::size_t>(side)] = std::move(*model);
    parts.made_by_handcast[static_cast<std::size_t>(side)] = file.empty();
  }
  return std::make_unique<RigTwin>(rig, calibration, std::move(parts));
}

}  // namespace handcast::twin
