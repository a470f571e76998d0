// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stereo_trial.hpp"

#include <ctime>

#include "ipc/base/clock.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/owned.hpp"
#include "services/evaluation/twin/camera_scene.hpp"
#include "services/evaluation/twin/twin.hpp"
#include "services/landmarks/detector.hpp"
#include "services/pose/stereo/stereo_tracker.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

double thread_time_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

/// The bend of a finger: from its metacarpal to its last bone, rad.
double bend_of(const renderer::JointFrames& truth, int finger) {
  const int first = 1 + 5 * finger;
  const auto along = [&](int joint) { return -glm::normalize(glm::dvec3(truth[joint][2])); };
  return std::acos(std::clamp(glm::dot(along(first), along(first + 3)), -1.0, 1.0));
}

double error_mm(const renderer::JointFrames& truth, const msg::HandPose& pose, int joint) {
  const auto& at = pose.joints[joint].position_m;
  return 1e3 * glm::distance(glm::dvec3(truth[joint][3]), glm::dvec3(at[0], at[1], at[2]));
}

/// Compares a sample with the true hands at `time_ns`.
void compare(const twin::Twin& twin, const msg::HandPoses& poses, std::int64_t time_ns,
             JointErrors& errors) {
  constexpr double kOpen_rad = 1.05, kFolded_rad = 1.75;
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto truth = twin.joints(side, time_ns);
    if (!truth) continue;
    ++errors.hands;
    const auto* pose = poses.find(side);
    if (!pose) {
      ++errors.missing;
      continue;
    }
    bool is_open = true;
    for (int f = 1; f < 5; ++f) {
      const double bend = bend_of(*truth, f);
      is_open = is_open && bend < kOpen_rad;
      if (bend > kFolded_rad) errors.folded_tips_mm.push_back(error_mm(*truth, *pose, 5 + 5 * f));
    }
    for (const int joint : msg::kJointOfLandmark) {
      const double mm = error_mm(*truth, *pose, joint);
      errors.all_mm.push_back(mm);
      if (is_open) errors.open_mm.push_back(mm);
    }
  }
}

/// One camera with its landmark detector.
class Eye {
 public:
  static Result<std::unique_ptr<Eye>> open(const StereoRig& stereo, bool is_second,
                                           const config::Rig& rig, const twin::Twin& twin) {
    const auto seen = is_second ? calib::second_view(stereo.calibration) : stereo.calibration;
    auto detector = landmarks::open_detector(rig, seen, 0);
    if (!detector) return tl::make_unexpected(detector.error());
    return std::make_unique<Eye>(stereo, is_second, seen, rig, twin, std::move(*detector));
  }

  Eye(const StereoRig& stereo, bool is_second, const calib::Calibration& seen,
      const config::Rig& rig, const twin::Twin& twin, std::unique_ptr<landmarks::Detector> detector)
      : twin_(twin),
        calibration_(seen),
        rows_(stereo.rows_per_row),
        scene_(rig.twin.image, rig.twin.seed + (is_second ? 1000 : 0), sensor_of(seen, rows_)),
        exposure_ns_(ms_to_ns(rig.camera.exposure_ms)),
        detector_(std::move(detector)),
        hints_(seen),
        raw_(seen.camera.width_px, seen.camera.height_px / rows_),
        frame_(sizeof(msg::CameraFrame) + static_cast<std::size_t>(seen.camera.width_px) *
                                              static_cast<std::size_t>(seen.camera.height_px)) {
    for (const auto side : {msg::Side::left, msg::Side::right})
      if (twin.joints(side, 0)) scene_.set_hand(side, twin.true_hand(side));
    frame_->width_px = static_cast<std::uint32_t>(seen.camera.width_px);
    frame_->height_px = static_cast<std::uint32_t>(seen.camera.height_px);
  }

  void tell(const msg::HandPoses& poses) { hints_.push(poses); }

  Result<msg::Landmarks> look(std::uint64_t k, std::int64_t time_ns, bool hints) {
    const auto truth = [this](msg::Side side, std::int64_t at_ns) {
      return twin_.joints(side, at_ns);
    };
    scene_.draw(k, time_ns, exposure_ns_, truth, raw_.view());
    double_rows();
    frame_->header = {k, time_ns, 0};
    return detector_->detect(*frame_, hints ? hints_.at(time_ns) : landmarks::Hints{},
                             Deadline::in(1h));
  }

  /// Errors of the landmarks at the depth of their joints, mm.
  void compare(const msg::Landmarks& seen, std::vector<double>& errors_mm) const {
    for (std::uint32_t h = 0; h < seen.count; ++h) {
      const auto truth = twin_.joints(seen.hands[h].side, seen.header.origin_ns);
      if (!truth) continue;
      for (int i = 0; i < msg::kLandmarks; ++i) {
        const glm::dvec3 at_m(calibration_.camera_from_tracker *
                              glm::dvec4((*truth)[msg::kJointOfLandmark[i]][3]));
        const auto& point = seen.hands[h].points[i];
        const double off_px =
            glm::distance(calibration_.camera.project(at_m), glm::dvec2(point.x_px, point.y_px));
        errors_mm.push_back(1e3 * off_px * at_m.z / calibration_.camera.fx_px);
      }
    }
  }

 private:
  /// The camera as its sensor has it, with fewer rows.
  static calib::Calibration sensor_of(calib::Calibration seen, int rows) {
    auto& camera = seen.camera;
    camera.height_px /= rows;
    camera.fy_px /= rows;
    camera.cy_px = (camera.cy_px + 0.5) / rows - 0.5;
    return seen;
  }

  /// Makes square pixels: a row of the sensor lies in the middle of its rows of the image.
  void double_rows() {
    const int width = calibration_.camera.width_px, height = calibration_.camera.height_px;
    for (int y = 0; y < height; ++y) {
      const double at = std::clamp((y + 0.5) / rows_ - 0.5, 0.0, raw_.height() - 1.0);
      const int above = static_cast<int>(at), below = std::min(above + 1, raw_.height() - 1);
      const double share = at - above;
      for (int x = 0; x < width; ++x)
        frame_->pixels()[y * width + x] = static_cast<std::uint8_t>(
            std::lround((1 - share) * raw_.at(x, above) + share * raw_.at(x, below)));
    }
  }

  const twin::Twin& twin_;
  calib::Calibration calibration_;
  int rows_;
  twin::CameraScene scene_;
  std::int64_t exposure_ns_;
  std::unique_ptr<landmarks::Detector> detector_;
  landmarks::TrackerHints hints_;
  renderer::Image<std::uint8_t> raw_;
  msg::Owned<msg::CameraFrame> frame_;
};

void compare_tracker(const twin::Twin& twin, double seconds, JointErrors& errors) {
  for (std::uint64_t k = 0; ns_to_seconds(twin.tracker_time_ns(k)) < seconds; ++k)
    compare(twin, twin.tracker_sample(k).poses, twin.tracker_time_ns(k), errors);
}

}  // namespace

void JointErrors::add(const JointErrors& more) {
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(all_mm, more.all_mm);
  append(open_mm, more.open_mm);
  append(folded_tips_mm, more.folded_tips_mm);
  hands += more.hands;
  missing += more.missing;
}

Result<StereoTrial> run_trial(const StereoRig& stereo, config::Rig rig, double seconds,
                              bool hints) {
  rig.twin.image.gain = stereo.gain;
  rig.landmarks.backend = "handcast";
  rig.pose.backend = hints ? "stereo" : "none";
  const auto twin = twin::Twin::create(rig, calib::reference_rig());
  if (!twin) return tl::make_unexpected(twin.error());
  auto first = Eye::open(stereo, false, rig, **twin), second = Eye::open(stereo, true, rig, **twin);
  if (!first) return tl::make_unexpected(first.error());
  if (!second) return tl::make_unexpected(second.error());
  auto tracker =
      pose::stereo::StereoTracker::open(rig, pose::stereo::views_of(stereo.calibration).value(),
                                        glm::inverse(stereo.calibration.camera_from_tracker));
  if (!tracker) return tl::make_unexpected(tracker.error());
  StereoTrial trial;
  const auto samples = static_cast<std::uint64_t>(seconds * stereo.rate_hz);
  for (std::uint64_t k = 0; k < samples; ++k) {
    const auto time_ns = seconds_to_ns(static_cast<double>(k + 1) / stereo.rate_hz);
    const auto here = (*first)->look(k, time_ns, hints);
    const auto there = (*second)->look(k, time_ns + ms_to_ns(stereo.second_later_ms), hints);
    if (!here) return tl::make_unexpected(here.error());
    if (!there) return tl::make_unexpected(there.error());
    (*first)->compare(*here, trial.landmarks_mm);
    (*second)->compare(*there, trial.landmarks_mm);
    const double begin_us = thread_time_us();
    const auto poses = tracker->sample({&*here, &*there});
    trial.work_us.push_back(thread_time_us() - begin_us);
    (*first)->tell(poses);
    (*second)->tell(poses);
    compare(**twin, poses, poses.header.origin_ns, trial.stereo);
  }
  compare_tracker(**twin, seconds, trial.tracker);
  return trial;
}

}  // namespace handcast::bench
