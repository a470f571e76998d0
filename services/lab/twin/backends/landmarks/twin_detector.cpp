// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "services/lab/twin/twin.hpp"
#include "services/landmarks/detector.hpp"

namespace handcast::landmarks {
namespace {

/// The twin's model of a detector in real time. The result is computed at once and returned after
/// the time that a detector takes.
class TwinDetector final : public Detector {
 public:
  TwinDetector(std::unique_ptr<twin::Twin> twin, std::int64_t epoch_ns)
      : twin_(std::move(twin)), epoch_ns_(epoch_ns) {}

  Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints&,
                                Deadline deadline) override {
    if (!under_way_) begin(frame.header);
    if (done_ns_ > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, "not finished by the deadline");
    }
    sleep_until_ns(done_ns_);
    const msg::Landmarks landmarks = *under_way_;
    under_way_.reset();
    return landmarks;
  }

  bool is_adjustable() const override { return true; }
  void adjust(const config::Rig& rig) override { twin_->adjust(rig.twin); }

 private:
  void begin(const msg::Header& seen) {
    const auto detection = twin_->detect(runs_++, seen.frame_id, seen.origin_ns - epoch_ns_);
    done_ns_ = std::max(seen.origin_ns + detection.age_ns,
                        now_ns() + detection.age_ns - oldest_ns(seen.frame_id));
    under_way_ = detection.landmarks;
    under_way_->header = {seen.frame_id, detection.landmarks.header.origin_ns + epoch_ns_, 0};
  }

  /// The largest age of the newest frame while the camera keeps its rate. Older frames take the
  /// same time.
  std::int64_t oldest_ns(std::uint64_t frame_id) const {
    return twin_->camera_arrival_ns(frame_id + 1) - twin_->camera_origin_ns(frame_id);
  }

  std::unique_ptr<twin::Twin> twin_;
  std::int64_t epoch_ns_;
  std::uint64_t runs_ = 0;
  std::optional<msg::Landmarks> under_way_;
  std::int64_t done_ns_ = 0;
};

}  // namespace

Result<std::unique_ptr<Detector>> open_twin(const Opening& with) {
  auto twin = twin::Twin::create(with.rig, with.calibration, with.at);
  if (!twin) return tl::make_unexpected(twin.error());
  return std::make_unique<TwinDetector>(std::move(*twin), with.epoch_ns);
}

}  // namespace handcast::landmarks
