// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <memory>
#include <string>

#include "services/lab/twin/twin.hpp"
#include "services/pose/stereo/stereo_tracker.hpp"

namespace handcast::pose::stereo {

/// The reference rig with a second camera 0.3 m beside the first, both axes towards the hands.
inline calib::Calibration two_cameras() {
  constexpr double kAside_m = 0.3, kFar_m = 0.73;
  const double length = std::hypot(kAside_m, kFar_m);
  const glm::dvec3 z(-kAside_m / length, 0, kFar_m / length), y(0, 1, 0), x = glm::cross(y, z);
  glm::dmat4 from_camera(glm::transpose(glm::dmat3(x, y, z)));
  from_camera[3] = glm::dvec4(-(glm::dmat3(from_camera) * glm::dvec3(kAside_m, 0, 0)), 1);
  auto calibration = calib::reference_rig();
  calibration.camera2 = calib::SecondCamera{{}, calibration.camera, from_camera};
  return calibration;
}

/// The twin's model of a detector in two views, and the tracker on it.
class TwoViews {
 public:
  explicit TwoViews(config::Rig rig, const std::string& motion = "wave")
      : rig_(std::move(rig)), calibration_(two_cameras()) {
    rig_.twin.motion = "builtin:" + motion;
    twins_[0] = twin::Twin::create(rig_, calibration_).value();
    twins_[1] = twin::Twin::create(rig_, calibration_, config::Viewpoint::second).value();
    tracker_ = std::make_unique<StereoTracker>(
        StereoTracker::open(rig_, views_of(calibration_).value(),
                            glm::inverse(calibration_.camera_from_tracker))
            .value());
  }

  /// What a view's detector reports of an image exposed at `time_ns`.
  msg::Landmarks seen(int view, std::int64_t time_ns) {
    const auto run = runs_++;
    auto landmarks = twins_[static_cast<std::size_t>(view)]->detect(run, run, time_ns).landmarks;
    landmarks.header.origin_ns = time_ns;
    return landmarks;
  }
  /// Distance of a joint from the true one, mm.
  double error_mm(const msg::HandPose& pose, int joint, std::int64_t time_ns) const {
    const auto truth = twins_[0]->joints(pose.side, time_ns).value();
    const auto& at = pose.joints[joint].position_m;
    return 1e3 * glm::distance(glm::dvec3(truth[joint][3]), glm::dvec3(at[0], at[1], at[2]));
  }
  /// The mean over the joints that have landmarks, mm.
  double error_mm(const msg::HandPose& pose, std::int64_t time_ns) const {
    double sum = 0;
    for (const int joint : msg::kJointOfLandmark) sum += error_mm(pose, joint, time_ns);
    return sum / msg::kLandmarks;
  }

  StereoTracker& tracker() { return *tracker_; }
  const twin::Twin& twin() const { return *twins_[0]; }
  const calib::Calibration& calibration() const { return calibration_; }

 private:
  config::Rig rig_;
  calib::Calibration calibration_;
  std::array<std::unique_ptr<twin::Twin>, kViews> twins_;
  std::unique_ptr<StereoTracker> tracker_;
  std::uint64_t runs_ = 0;
};

/// The defaults, with a detector that errs by white noise alone.
inline config::Rig with_noise(double noise_px) {
  config::Rig rig;
  rig.twin.detector.noise_px = noise_px;
  return rig;
}

}  // namespace handcast::pose::stereo
