// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/frame_detector.hpp"

#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/owned.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/landmarks/models/mediapipe_files.hpp"
#include "services/landmarks/models/models_folder.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"

namespace handcast::simulate {
namespace {

using namespace std::chrono_literals;

std::size_t pixels_of(const calib::CameraModel& camera) {
  return static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
}

class TwinDetector final : public FrameDetector {
 public:
  explicit TwinDetector(const twin::Twin& twin) : twin_(twin) {}

  Detection detect(std::uint64_t run, const Exposure& exposure) override {
    const auto model = twin_.detect(run, exposure.frame_id, exposure.stamp_ns);
    return {model.landmarks, model.age_ns, 0};
  }

 private:
  const twin::Twin& twin_;
};

/// A detector of services/landmarks, called as by its daemon.
class RealDetector final : public FrameDetector {
 public:
  RealDetector(std::unique_ptr<landmarks::Detector> detector, double exposure_ms,
               const calib::PlacedCamera& camera, const twin::Twin& twin)
      : detector_(std::move(detector)),
        twin_(twin),
        tracker_(camera),
        frame_(sizeof(msg::CameraFrame) + pixels_of(camera.model)) {
    frame_->exposure_ns = ms_to_ns(exposure_ms);
    frame_->width_px = static_cast<std::uint32_t>(camera.model.width_px);
    frame_->height_px = static_cast<std::uint32_t>(camera.model.height_px);
  }

  void tell(const msg::HandPoses& poses) override { tracker_.push(poses); }

  Detection detect(std::uint64_t run, const Exposure& exposure) override {
    frame_->header = {exposure.frame_id, exposure.stamp_ns,
                      twin_.camera_arrival_ns(exposure.frame_id)};
    const int width = static_cast<int>(frame_->width_px),
              height = static_cast<int>(frame_->height_px);
    twin_.camera_image(exposure.frame_id, {frame_->pixels(), width, height, width});
    const auto begin_ns = now_ns();
    auto found = detector_->detect(*frame_, tracker_.at(exposure.stamp_ns), Deadline::in(1h));
    const auto work_ns = now_ns() - begin_ns;
    const auto model = twin_.detect(run, exposure.frame_id, exposure.stamp_ns);
    if (!found) return {std::nullopt, model.age_ns, work_ns};
    twin_.spoil(run, exposure.origin_ns, *found);
    found->header = model.landmarks.header;
    return {*found, model.age_ns, work_ns};
  }

 private:
  std::unique_ptr<landmarks::Detector> detector_;
  const twin::Twin& twin_;
  landmarks::TrackerHints tracker_;
  msg::Owned<msg::CameraFrame> frame_;
};

}  // namespace

std::unique_ptr<FrameDetector> make_twin_detector(const twin::Twin& twin) {
  return std::make_unique<TwinDetector>(twin);
}

std::vector<std::filesystem::path> network_files(const config::Rig& rig) {
  const auto folder = landmarks::models_folder(rig.landmarks.models);
  const auto backend = landmarks::choose_detector(rig).backend;
  for (const auto& model : landmarks::landmark_models()) {
    if (model.name != backend || !folder) continue;
    auto files = model.files({.folder = *folder});
    files.push_back(*folder / landmarks::kMediapipePalmFile);  // read by each of them if it exists
    return files;
  }
  return {};
}

Result<std::unique_ptr<FrameDetector>> open_frame_detector(const config::Rig& rig,
                                                           const calib::Calibration& calibration,
                                                           const twin::Twin& twin,
                                                           config::Viewpoint at) {
  if (landmarks::choose_detector(rig, at).backend == "twin") return make_twin_detector(twin);
  const auto camera = calib::camera_at(calibration, at);
  if (!camera) return tl::make_unexpected(camera.error());
  auto detector = landmarks::open_detector(rig, calibration, 0, at);
  if (!detector) return tl::make_unexpected(detector.error());
  return std::make_unique<RealDetector>(std::move(*detector),
                                        config::camera_at(rig, at).exposure_ms, *camera, twin);
}

}  // namespace handcast::simulate
