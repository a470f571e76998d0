// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "services/landmarks/detector.hpp"
#include "services/landmarks/finder/hand_finder.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/landmarks/models/models_folder.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"

namespace handcast::landmarks {
namespace {

/// A landmark model on the camera's images.
class NetworkDetector final : public Detector {
 public:
  /// `has_hints`: false if the poses of the rig are made from these landmarks alone, which would be
  /// hints of their own.
  NetworkDetector(HandFinder finder, const calib::CameraModel& camera, bool has_hints)
      : finder_(std::move(finder)), camera_(camera), has_hints_(has_hints) {}

  Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints& told,
                                Deadline) override {
    const Hints hints = has_hints_ ? told : Hints{};
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
    for (const auto& hand : *found) landmarks.hands[landmarks.count++] = message_of(hand);
    return landmarks;
  }

 private:
  msg::HandLandmarks message_of(const FoundHand& hand) const {
    const Points points_px = undistorted(camera_, hand.points_px);
    msg::HandLandmarks message{hand.side, hand.presence, {}};
    for (std::size_t i = 0; i < points_px.size(); ++i)
      message.points[i] = {points_px[i].x, points_px[i].y,
                           camera_.contains(hand.points_px[i]) ? hand.confidences[i] : 0,
                           hand.sigma_px[i]};
    return message;
  }

  HandFinder finder_;
  calib::CameraModel camera_;
  bool has_hints_;
};

/// Networks, and the mask, take a hand for one whose image has the same scale in all directions.
Result<void> check_pixels(const calib::CameraModel& camera) {
  constexpr double kMost = 1.1;
  const double height = camera.fx_px / camera.fy_px;
  if (height < kMost && height > 1 / kMost) return {};
  return fail(Errc::bad_config,
              fmt::format("the camera's pixels are {:.3g} times as high as wide (focal_px in the "
                          "calibration); landmarks are found in images with square pixels, which "
                          "the Leap controller gives with a calibration for 640x480",
                          height));
}

}  // namespace

Result<std::unique_ptr<Detector>> open_network_detector(const Opening& with) {
  const auto& settings = with.settings;
  const auto& pose = with.rig.pose;
  if (auto square = check_pixels(with.camera.model); !square)
    return tl::make_unexpected(square.error());
  const auto folder = models_folder(settings.models);
  if (!folder) return fail_in("models", folder.error());
  auto model = open_landmark_model(settings.backend, {.folder = *folder});
  if (!model) return tl::make_unexpected(model.error());
  const bool has_hints = pose.backend != "none";
  // The poses of `stereo` are made from these landmarks, too, but of two views: good hints, once
  // the hands were found.
  const bool lifts = !has_hints || pose.backend == "stereo" || pose.second == "stereo";
  HandFinder finder(std::move(*model), settings.hands,
                    lifts ? HandFinder::Poses::of_landmarks : HandFinder::Poses::of_a_tracker);
  return std::make_unique<NetworkDetector>(std::move(finder), with.camera.model, has_hints);
}

}  // namespace handcast::landmarks
