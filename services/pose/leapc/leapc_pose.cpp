// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/pose/leapc/connection.hpp"
#include "services/pose/pose_source.hpp"

namespace handcast::pose {
namespace {

/// About the rate of a device. Only so that numbers go on over restarts of the service.
constexpr std::int64_t kPeriod_ns = 9'000'000;

Error hang() { return {Errc::unavailable, "Ultraleap's library hangs: a call does not return"}; }

/// A Leap Motion or Ultraleap device. A service or device that is away is waited for: its absence
/// is a timeout that says so. A library that hangs is an error that ends the service.
class LeapcPose final : public PoseSource {
 public:
  LeapcPose(leapc::Library library, const config::Leapc& settings, std::uint64_t first_id)
      : connection_(std::move(library), settings, first_id, mailbox_) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    const auto taken = mailbox_.take(deadline);
    if (!taken) return fail_in("pose 'leapc'", connection_.hangs() ? hang() : taken.error());
    poses = *taken;
    return {};
  }

  joints::Conventions conventions() const override { return joints::kLeap; }

 private:
  leapc::Mailbox mailbox_;
  leapc::Connection connection_;
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_leapc(const config::Rig& rig, const calib::Calibration&,
                                               const Surroundings& around) {
  auto library = leapc::open_library(rig.pose.leapc.library);
  if (!library) return fail_in("pose 'leapc'", library.error());
  const std::int64_t running_ns = std::max<std::int64_t>(now_ns() - around.epoch_ns, 0);
  return std::make_unique<LeapcPose>(std::move(*library), rig.pose.leapc,
                                     static_cast<std::uint64_t>(running_ns / kPeriod_ns));
}

Result<void> check_leapc(const config::Rig& rig, const calib::Calibration&, const Surroundings&) {
  const auto library = leapc::open_library(rig.pose.leapc.library);
  if (!library) return fail_in("pose 'leapc'", library.error());
  return {};
}

}  // namespace handcast::pose
