// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "services/pose/lift/lifter.hpp"
#include "services/pose/pose_source.hpp"

namespace handcast::pose {
namespace {

/// A rig without a tracker: each sample is made from the landmarks of one image and has its origin.
class NonePose final : public PoseSource {
 public:
  explicit NonePose(const Lifter& lifter) : lifter_(lifter) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    if (!seen_) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, "pose 'none': no landmarks before the deadline");
    }
    poses = lifter_.lift(*seen_);
    seen_.reset();
    return {};
  }

  int views() const override { return 1; }
  joints::Conventions conventions() const override {
    return {
        .place = joints::Place::model, .has_measured_axes = false, .radii = joints::Radii::model};
  }
  void see(const msg::Landmarks& landmarks, int /*view*/) override { seen_ = landmarks; }

 private:
  Lifter lifter_;
  std::optional<msg::Landmarks> seen_;
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_none(const config::Rig& rig,
                                              const calib::Calibration& calibration,
                                              const Surroundings&) {
  auto lifter = Lifter::open(rig, calibration);
  if (!lifter) return fail_in("pose 'none'", lifter.error());
  return std::make_unique<NonePose>(*lifter);
}

}  // namespace handcast::pose
