// SPDX-License-Identifier: Apache-2.0
#include "ipc/msg/guest_streams.hpp"
#include "services/pose/pose_source.hpp"
#include "services/runtime/guest_stream.hpp"

namespace handcast::pose {
namespace {

/// The samples of a program that is not part of the rig (ipc/client/handcast.h). One that sends
/// nothing is a tracker that is silent; the landmarks then carry the light alone. The first sample
/// has no hand if no program sends yet, so that the rig need not wait for one.
class ExternalPose final : public PoseSource {
 public:
  explicit ExternalPose(service::GuestStream<msg::HandPoses> guests) : guests_(std::move(guests)) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    const auto sent = guests_.latest(deadline);
    if (!sent && (number_ > 0 || sent.error().code != Errc::timeout))
      return fail_in("pose 'external'", sent.error());
    poses = sent ? **sent : msg::HandPoses{.header = {.origin_ns = now_ns()}};
    poses.header = {++number_, poses.header.origin_ns, 0};
    poses.calibration = 0;
    return {};
  }

  joints::Conventions conventions() const override {
    return {.place = joints::Place::as_sent,
            .has_measured_palm = true,
            .radii = joints::Radii::as_sent};
  }

 private:
  service::GuestStream<msg::HandPoses> guests_;
  std::uint64_t number_ = 0;
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_external(const config::Rig& rig, const calib::Calibration&,
                                                  const Surroundings& around) {
  auto guests = service::GuestStream<msg::HandPoses>::open(around.ring, msg::kGuestPoses,
                                                           rig.pose.process.wait);
  if (!guests) return fail_in("pose 'external'", guests.error());
  return std::make_unique<ExternalPose>(std::move(*guests));
}

}  // namespace handcast::pose
