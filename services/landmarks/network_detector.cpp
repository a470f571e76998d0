// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "services/landmarks/detector.hpp"
#include "services/landmarks/finder/hints.hpp"
#include "services/landmarks/finder/joint_convention.hpp"
#include "services/landmarks/finder/models.hpp"
#include "services/landmarks/finder/own_finder.hpp"

namespace handcast::landmarks {
namespace {

/// A network on the images themselves.
class NetworkDetector final : public Detector {
 public:
  NetworkDetector(HandFinder finder, const calib::CameraModel& camera, bool as_the_tracker)
      : finder_(std::move(finder)), camera_(camera), as_the_tracker_(as_the_tracker) {}

  Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints& hints,
                                Deadline) override {
    if (static_cast<int>(frame.width_px) != camera_.width_px ||
        static_cast<int>(frame.height_px) != camera_.height_px)
      return fail(
          Errc::bad_data,
          fmt::format("an image of {} x {} px, but the calibration is for a camera of {} x {} px",
                      frame.width_px, frame.height_px, camera_.width_px, camera_.height_px));
    Hints in_image;
    for (std::size_t side = 0; side < hints.size(); ++side)
      if (hints[side]) in_image[side] = distorted(camera_, *hints[side]);
    const renderer::GreyView image{frame.pixels(), camera_.width_px, camera_.height_px,
                                   camera_.width_px};
    const auto found = finder_.find(image, in_image, frame.header.origin_ns);
    if (!found) return tl::make_unexpected(found.error());

    msg::Landmarks landmarks;
    landmarks.header = {frame.header.frame_id, frame.header.origin_ns, 0};
    for (const auto& hand : *found)
      landmarks.hands[landmarks.count++] = message_of(hand, hints, frame.header.origin_ns);
    return landmarks;
  }

 private:
  msg::HandLandmarks message_of(const FoundHand& hand, const Hints& hints, std::int64_t time_ns) {
    const auto side = static_cast<std::size_t>(hand.side);
    Points points_px = undistorted(camera_, hand.points_px);
    if (as_the_tracker_) {
      if (hints[side] && is_well_seen(hand))
        definitions_[side].learn(time_ns, points_px, *hints[side]);
      points_px = definitions_[side].to_tracker(points_px);
    }
    msg::HandLandmarks message{hand.side, hand.presence, {}};
    for (std::size_t i = 0; i < points_px.size(); ++i)
      message.points[i] = {points_px[i].x, points_px[i].y,
                           is_in_image(hand.points_px[i]) ? hand.confidences[i] : 0,
                           hand.sigma_px[i]};
    return message;
  }

  bool is_well_seen(const FoundHand& hand) const {
    return mean_of(hand.confidences) >= HandFinder::kSteadyConfidence &&
           std::ranges::all_of(hand.points_px,
                               [this](glm::vec2 point_px) { return is_in_image(point_px); });
  }

  bool is_in_image(glm::vec2 at_px) const {
    return at_px.x >= -0.5f && at_px.y >= -0.5f &&
           at_px.x < static_cast<float>(camera_.width_px) - 0.5f &&
           at_px.y < static_cast<float>(camera_.height_px) - 0.5f;
  }

  HandFinder finder_;
  calib::CameraModel camera_;
  bool as_the_tracker_;
  std::array<JointConventionOffsets, msg::kMaxHands> definitions_;
};

Result<std::unique_ptr<Detector>> open_with(const char* backend, const config::Rig& rig,
                                            const calib::Calibration& calibration) {
  const auto& settings = rig.landmarks;
  auto finder = HandFinder::open(backend, models_folder(settings.models), settings.hands);
  if (!finder) return fail_in(fmt::format("landmarks '{}'", backend), finder.error());
  return std::make_unique<NetworkDetector>(
      std::move(*finder), calibration.camera,
      settings.definition == config::LandmarkDefinition::tracker);
}

}  // namespace

/// Its points are the tracker's joints already.
Result<std::unique_ptr<Detector>> open_own(const config::Rig& rig,
                                           const calib::Calibration& calibration,
                                           const std::int64_t&) {
  const auto& settings = rig.landmarks;
  auto finder = own::open_finder(models_folder(settings.models), settings.hands);
  if (!finder) return fail_in("landmarks 'own'", finder.error());
  return std::make_unique<NetworkDetector>(std::move(*finder), calibration.camera, false);
}

Result<std::unique_ptr<Detector>> open_onednn(const config::Rig& rig,
                                              const calib::Calibration& calibration,
                                              const std::int64_t&) {
  return open_with("onednn", rig, calibration);
}

Result<std::unique_ptr<Detector>> open_opencv(const config::Rig& rig,
                                              const calib::Calibration& calibration,
                                              const std::int64_t&) {
  return open_with("opencv", rig, calibration);
}

}  // namespace handcast::landmarks
