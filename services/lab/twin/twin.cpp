// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/twin.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "calib/sub_frames.hpp"
#include "ipc/base/clock.hpp"
#include "services/lab/twin/board_scene.hpp"
#include "services/lab/twin/camera_scene.hpp"
#include "services/lab/twin/detector.hpp"
#include "services/lab/twin/random.hpp"
#include "services/lab/twin/sensor_clock.hpp"
#include "services/lab/twin/tracker.hpp"

namespace handcast::twin {
namespace {

/// The times of the twin's camera: what is true, and what its stamps say. Pure functions of the
/// settings, the seed and the number of the frame. Times are ns since the rig's epoch.
class CameraTimes {
 public:
  /// Copies what it needs.
  CameraTimes(const config::Camera& camera, const config::Twin& twin);

  /// The true middle of the exposure of frame `k`.
  std::int64_t origin_ns(std::uint64_t k) const;
  /// The middle of its exposure by the camera's clock: the only time that the cascade sees.
  std::int64_t stamp_ns(std::uint64_t k) const { return clock_.stamp_ns(k, origin_ns(k)); }
  /// The time at which frame `k` is in memory. Does not decrease with k.
  std::int64_t arrival_ns(std::uint64_t k) const;
  /// True if frame `k` never arrives.
  bool lost(std::uint64_t k) const;
  /// The true time of the image of this id and stamp. An image that is not this camera's is taken
  /// at its stamp.
  std::int64_t true_ns(std::uint64_t frame_id, std::int64_t stamp) const {
    return stamp == stamp_ns(frame_id) ? origin_ns(frame_id) : stamp;
  }

 private:
  double rate_hz_, lost_, burst_;
  std::int64_t transfer_ns_;  ///< from the middle of an exposure to the image in memory
  Random loss_, bursts_;
  SensorClock clock_;
};

CameraTimes::CameraTimes(const config::Camera& camera, const config::Twin& twin)
    : rate_hz_(camera.rate_hz),
      lost_(twin.image.lost),
      burst_(twin.image.burst),
      transfer_ns_(ms_to_ns(camera.exposure_ms) / 2 + ms_to_ns(twin.image.delivery_ms)),
      loss_(twin.seed, Stream::camera_loss),
      bursts_(twin.seed, Stream::camera_burst),
      clock_(twin.image.clock, 0, seconds_to_ns(1 / camera.rate_hz),
             Random(twin.seed, Stream::camera_clock)) {}

std::int64_t CameraTimes::origin_ns(std::uint64_t k) const {
  return seconds_to_ns(static_cast<double>(k) / rate_hz_);
}

std::int64_t CameraTimes::arrival_ns(std::uint64_t k) const {
  return burst_arrival_ns(k, burst_, bursts_,
                          [this](std::uint64_t i) { return origin_ns(i) + transfer_ns_; });
}

bool CameraTimes::lost(std::uint64_t k) const { return loss_.uniform(k) < lost_; }

constexpr std::array<Side, 2> kSides{Side::left, Side::right};

/// The camera through which the twin is seen.
struct SeenFrom {
  calib::PlacedCamera truth;    ///< its true lens and place
  calib::CameraModel believed;  ///< its lens by the rig's calibration
  config::Camera settings;      ///< its section of the rig
  int seed;                     ///< of its noise and its detector's errors
  glm::dmat4 from_first{1};     ///< from the space of the first camera to its own
};

class RigTwin final : public Twin {
 public:
  RigTwin(const config::Rig& rig, const TrueGeometry& geometry, const SeenFrom& view,
          std::unique_ptr<Motion> motion, std::unique_ptr<TrueHands> hands)
      : geometry_(geometry),
        view_(view),
        exposure_ns_(ms_to_ns(view.settings.exposure_ms)),
        camera_(view.settings, rig.twin),
        absent_(rig.twin.hands == config::TwinHands::left    ? std::optional(Side::right)
                : rig.twin.hands == config::TwinHands::right ? std::optional(Side::left)
                                                             : std::nullopt),
        motion_(std::move(motion)),
        hands_(std::move(hands)),
        tracker_(rig.twin.tracker, rig.twin.seed, geometry.calibration(), motion_->shape()),
        detector_(rig.twin.detector, view.seed, view.truth.model, motion_->shape()),
        settings_(rig.twin) {}

  void adjust(const config::Twin& changed) override {
    if (std::exchange(settings_.tracker, changed.tracker) != changed.tracker)
      tracker_ = {changed.tracker, settings_.seed, geometry_.calibration(), motion_->shape()};
    if (std::exchange(settings_.detector, changed.detector) != changed.detector)
      detector_ = {changed.detector, view_.seed, view_.truth.model, motion_->shape()};
    if (std::exchange(settings_.image, changed.image) == changed.image) return;
    camera_ = {view_.settings, settings_};
    scene_.reset();
    if (board_) place_board();
  }

  std::optional<JointFrames> joints(Side side, std::int64_t time_ns) const override {
    if (side == absent_ || settings_.prop.kind != config::TwinPropKind::none) return std::nullopt;
    return motion_->at(side, ns_to_seconds(time_ns));
  }

  const TrueHands& hands() const override { return *hands_; }
  const TrueGeometry& geometry() const override { return geometry_; }

  std::optional<std::array<glm::vec2, msg::kLandmarks>> landmarks(
      Side side, std::int64_t time_ns) const override {
    const auto truth = joints(side, time_ns);
    if (!truth) return std::nullopt;
    const auto& truth_camera = view_.truth.model;
    const auto& camera_from_tracker = view_.truth.from_tracker;
    std::array<glm::vec2, msg::kLandmarks> points;
    for (int i = 0; i < msg::kLandmarks; ++i) {
      const glm::dvec4 place((*truth)[msg::kJointOfLandmark[i]][3]);
      points[i] = view_.believed.undistort(
          truth_camera.distort(truth_camera.project(glm::dvec3(camera_from_tracker * place))));
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
    if (board_) return board_->draw(k, camera_origin_ns(k), exposure_ns_, nullptr, image);
    const auto truth = [this](Side side, std::int64_t time_ns) { return joints(side, time_ns); };
    scene().draw(k, camera_origin_ns(k), exposure_ns_, truth, image);
  }

  void camera_image(std::uint64_t k, const Light& light,
                    renderer::View<std::uint8_t> image) const override {
    if (!board_) return camera_image(k, image);
    board_->draw(k, camera_origin_ns(k), exposure_ns_, &light, image);
  }

  Result<void> show_board(const FlatPicture& picture) override {
    if (settings_.prop.kind != config::TwinPropKind::board)
      return fail(Errc::bad_config, "twin: no board is held, because twin.prop.kind is not board");
    if (settings_.prop.views != config::TwinPropViews::first && !geometry_.calibration().camera2)
      return fail(Errc::bad_config,
                  "twin: the rig has one camera; set twin.prop.views = \"first\"");
    if (auto usable = check(picture); !usable) return usable;
    picture_ = picture;
    place_board();
    return {};
  }

  std::optional<glm::dmat4> board_pose(std::int64_t time_ns) const override {
    if (!board_) return std::nullopt;
    return board_->camera_from_board(time_ns);
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

  void spoil(std::uint64_t n, std::int64_t origin_ns, msg::Landmarks& found) const override {
    if (detector_.lost(n, origin_ns)) found.count = 0;
    for (std::uint32_t i = 0; i < found.count; ++i) detector_.spoil(n, origin_ns, found.hands[i]);
  }

 private:
  JointFrames in_camera(JointFrames frames) const {
    const glm::dmat4& camera_from_tracker = view_.truth.from_tracker;
    for (auto& frame : frames) frame = glm::mat4(camera_from_tracker * glm::dmat4(frame));
    return frames;
  }

  void place_board() {
    board_.emplace(settings_, geometry_, SceneView{view_.truth.model, view_.from_first, view_.seed},
                   picture_);
  }

  CameraScene& scene() const {
    if (scene_) return *scene_;
    scene_.emplace(settings_.image, view_.seed, view_.truth);
    for (const Side side : kSides) scene_->set_hand(side, true_hand(side));
    return *scene_;
  }

  TrueGeometry geometry_;
  SeenFrom view_;
  std::int64_t exposure_ns_;
  CameraTimes camera_;
  std::optional<Side> absent_;  ///< the hand of the motion that is left out
  std::unique_ptr<Motion> motion_;
  std::unique_ptr<TrueHands> hands_;
  TrackerModel tracker_;
  DetectorModel detector_;
  config::Twin settings_;
  mutable std::optional<CameraScene> scene_;  ///< made for the first image
  FlatPicture picture_;                       ///< of the board
  mutable std::optional<BoardScene> board_;   ///< empty without the picture of a board
};

}  // namespace

/// The calibration from which the true rig differs by twin.geometry. If its file has no second
/// camera, that is where it is believed to be, relative to the true first one.
static Result<calib::Calibration> true_base(const config::Rig& rig,
                                            const calib::Calibration& believed) {
  const auto& file = rig.twin.geometry.calibration;
  if (file.empty()) return believed;
  auto base = calib::load_calibration(file, rig.projector.packing);
  const auto has_other_size = [](const calib::CameraModel& a, const calib::CameraModel& b) {
    return a.width_px != b.width_px || a.height_px != b.height_px;
  };
  if (base && (has_other_size(base->camera, believed.camera) ||
               (base->camera2 && believed.camera2 &&
                has_other_size(base->camera2->camera, believed.camera2->camera)) ||
               base->projector.width_px != believed.projector.width_px ||
               base->projector.height_px != believed.projector.height_px))
    return fail(Errc::bad_config, fmt::format("twin.geometry.calibration: {} has images of other "
                                              "sizes than the calibration of the rig",
                                              file));
  if (base && !base->camera2) base->camera2 = believed.camera2;
  if (base) base->projector2 = believed.projector2;
  return base;
}

/// Errors: bad_config (the calibration has no such camera).
static Result<SeenFrom> seen_from(const config::Rig& rig, const calib::Calibration& calibration,
                                  const TrueGeometry& geometry, config::Viewpoint at) {
  constexpr int kOtherSeed = 1000;
  const auto believed = calib::camera_at(calibration, at);
  if (!believed) return tl::make_unexpected(believed.error());
  const auto& truth = geometry.calibration();
  SeenFrom view{calib::camera_at(truth, at).value(), believed->model, config::camera_at(rig, at),
                rig.twin.seed};
  if (at == config::Viewpoint::first) return view;
  view.seed += kOtherSeed;
  view.from_first = truth.camera2->from_camera;
  return view;
}

Result<std::unique_ptr<Twin>> Twin::create(const config::Rig& rig,
                                           const calib::Calibration& calibration,
                                           config::Viewpoint at) {
  const auto base = true_base(rig, calibration);
  if (!base) return tl::make_unexpected(base.error());
  const TrueGeometry geometry(rig.twin.geometry, rig.twin.seed, *base, calibration.camera);
  const auto view = seen_from(rig, calibration, geometry, at);
  if (!view) return tl::make_unexpected(view.error());
  auto motion = open_motion(rig.twin, geometry.calibration());
  if (!motion) return tl::make_unexpected(motion.error());
  const auto moves = [&](Side side) { return (*motion)->at(side, 0).has_value(); };
  auto hands = TrueHands::create(rig, {moves(Side::left), moves(Side::right)}, (*motion)->shape());
  if (!hands) return tl::make_unexpected(hands.error());
  return std::make_unique<RigTwin>(rig, geometry, *view, std::move(*motion), std::move(*hands));
}

}  // namespace handcast::twin
