// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "config/second_view.hpp"
#include "services/pose/pose_source.hpp"
#include "services/pose/stereo/pairing.hpp"
#include "services/pose/stereo/stereo_tracker.hpp"

namespace handcast::pose {
namespace {

/// A tracker of two cameras: each sample is made from the landmarks of both, or of one if the other
/// is late, and has the origin of the newer image.
class StereoPose final : public PoseSource {
 public:
  StereoPose(const stereo::StereoTracker& tracker, const config::PoseStereo& settings)
      : tracker_(tracker), pairing_(settings) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    while (true) {
      if (const auto pair = pairing_.take(now_ns())) {
        poses = tracker_.sample(stereo::seen_of(*pair));
        return {};
      }
      const auto due_ns = pairing_.due_ns();
      if (!due_ns || *due_ns > deadline.time_ns()) break;
      sleep_until_ns(*due_ns);
    }
    sleep_until_ns(deadline.time_ns());
    return fail(Errc::timeout, "pose 'stereo': no landmarks before the deadline");
  }

  joints::Conventions conventions() const override {
    return {
        .place = joints::Place::model, .has_measured_axes = false, .radii = joints::Radii::model};
  }
  int views() const override { return stereo::kViews; }
  int awaited_view() const override { return pairing_.awaited_view(); }
  void see(const msg::Landmarks& landmarks, int view) override {
    pairing_.push(view, landmarks, now_ns());
  }

 private:
  stereo::StereoTracker tracker_;
  stereo::Pairing pairing_;
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_stereo(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                const Surroundings&) {
  if (!config::has_second_images(rig))
    return fail(
        Errc::bad_config,
        "pose 'stereo': the rig has no second camera; set camera2.backend, or take a camera "
        "with two eyes (camera.backend = \"leap\")");
  const auto views = stereo::views_of(calibration);
  if (!views) return fail_in("pose 'stereo'", views.error());
  auto tracker =
      stereo::StereoTracker::open(rig, *views, glm::inverse(calibration.camera_from_tracker));
  if (!tracker) return fail_in("pose 'stereo'", tracker.error());
  return std::make_unique<StereoPose>(*tracker, rig.pose.stereo);
}

}  // namespace handcast::pose
