// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/twin.hpp"
#include "services/pose/pose_source.hpp"
#include "services/runtime/first_at.hpp"

namespace handcast::pose {
namespace {

/// Samples that are later than this are skipped, so that a tracker that was stopped continues with
/// the present.
constexpr std::int64_t kLatest_ns = 50'000'000;

/// The twin's tracker in real time. Each sample is delivered at its arrival, with the age that the
/// rig file sets.
class TwinPose final : public PoseSource {
 public:
  TwinPose(std::unique_ptr<twin::Twin> twin, std::int64_t epoch_ns)
      : twin_(std::move(twin)), epoch_ns_(epoch_ns) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    const auto arrival_ns = [&](std::uint64_t k) {
      return epoch_ns_ + twin_->tracker_sample(k).arrival_ns;
    };
    next_ = timing::first_at(next_, now_ns() - kLatest_ns, arrival_ns);
    const auto sample = twin_->tracker_sample(next_);
    if (epoch_ns_ + sample.arrival_ns > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, "pose 'twin': no sample before the deadline");
    }
    sleep_until_ns(epoch_ns_ + sample.arrival_ns);
    poses = sample.poses;
    poses.header.origin_ns += epoch_ns_;
    ++next_;
    return {};
  }

  bool is_adjustable() const override { return true; }
  void adjust(const config::Rig& rig) override { twin_->adjust(rig.twin); }

  joints::Conventions conventions() const override {
    return {.place = joints::Place::model, .radii = joints::Radii::model};
  }

 private:
  std::unique_ptr<twin::Twin> twin_;
  std::int64_t epoch_ns_;
  std::uint64_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_twin(const config::Rig& rig,
                                              const calib::Calibration& calibration,
                                              const Surroundings& around) {
  auto twin = twin::Twin::create(rig, calibration);
  if (!twin) return fail_in("pose 'twin'", twin.error());
  return std::make_unique<TwinPose>(std::move(*twin), around.epoch_ns);
}

}  // namespace handcast::pose
