// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ipc/base/log.hpp"
#include "services/pose/openxr/manifest.hpp"
#include "services/pose/openxr/polls.hpp"
#include "services/pose/openxr/sampler.hpp"
#include "services/pose/openxr/session.hpp"
#include "services/pose/pose_source.hpp"

namespace handcast::pose {
namespace {

using namespace std::chrono_literals;

constexpr auto kStart = 5s;  ///< a runtime that is not ready by then is tried again later

/// The hand tracker of an OpenXR runtime. A runtime answers for the time that it is asked for and
/// does not say when it measured. Where its answers depend on the time, the origin of a sample is
/// the time that was asked for: pose.openxr.age_ms before the poll, or predict_ms after it. Where
/// they do not, they are the newest joints that it has measured; a sample is then only what has
/// come since the poll just before, and its origin is age_ms before that.
class OpenXrPose final : public PoseSource {
 public:
  OpenXrPose(std::unique_ptr<openxr::Session> session, const config::OpenXr& settings,
             std::int64_t start_ns)
      : session_(std::move(session)),
        polls_(settings.rate_hz, start_ns),
        age_ns_(ms_to_ns(settings.age_ms)),
        predict_ns_(ms_to_ns(settings.predict_ms)) {}

  /// Makes the first poll, which no sample can come from.
  Result<void> begin(std::int64_t poll_ns) {
    msg::HandPoses unused;
    return session_->locate(asked_ns(poll_ns))
        .and_then([&](const openxr::Answers& answers) { return sampler_.take(answers, unused); })
        .map([](bool) {});
  }

  joints::Conventions conventions() const override {
    return {.place = joints::Place::bones,
            .has_measured_palm = true,
            .radii = joints::Radii::bone_widths};
  }

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    for (;;) {
      const std::int64_t poll_ns = polls_.next_ns(now_ns());
      if (poll_ns > deadline.time_ns()) {
        sleep_until_ns(deadline.time_ns());
        return fail(Errc::timeout, "pose 'openxr': no new joints before the deadline");
      }
      sleep_until_ns(poll_ns);
      const auto is_new = poll(poll_ns, poses);
      if (!is_new) return fail_in("pose 'openxr'", is_new.error());
      if (*is_new) return {};
    }
  }

 private:
  std::int64_t asked_ns(std::int64_t poll_ns) const {
    return predict_ns_ > 0 ? poll_ns + predict_ns_ : poll_ns - age_ns_;
  }

  /// Returns whether there is a new sample, which is in `poses` then.
  Result<bool> poll(std::int64_t poll_ns, msg::HandPoses& poses) {
    poses = {};
    auto is_new = session_->tend().and_then([&] { return ask(poll_ns, poses); });
    // After an error there is nothing to listen for.
    polls_.made(!is_new || *is_new);
    return is_new;
  }

  Result<bool> ask(std::int64_t poll_ns, msg::HandPoses& poses) {
    const std::int64_t asked_ns = this->asked_ns(poll_ns), asked_at_ns = now_ns();
    const auto answers = session_->locate(asked_ns);
    if (!answers) return tl::make_unexpected(answers.error());
    auto is_new = sampler_.take(*answers, poses);
    if (!is_new || !*is_new) return is_new;
    auto is_newest = are_newest(asked_ns, *answers);
    if (!is_newest) return is_newest;
    if (*is_newest && !polls_.is_listening()) return false;  // nobody knows since when
    // A process that wakes late asks late: what came meanwhile was not there at `poll_ns`.
    const std::int64_t origin_ns = *is_newest ? asked_at_ns - age_ns_ : asked_ns;
    if (origin_ns <= last_ns_) return false;
    last_ns_ = origin_ns;
    poses.header.frame_id = polls_.number(poll_ns);
    poses.header.origin_ns = origin_ns;
    return true;
  }

  /// Whether the answers are the same for a later time, or for an earlier one that is not over yet:
  /// then they are the newest that was measured.
  Result<bool> are_newest(std::int64_t asked_ns, const openxr::Answers& answers) {
    const std::int64_t now = now_ns();
    const auto others = session_->locate(predict_ns_ > 0 ? now + (asked_ns - now) / 2 : now);
    if (!others) return tl::make_unexpected(others.error());
    if (openxr::Sampler::are_equal(answers, *others)) return true;
    if (predict_ns_ == 0) return false;
    // Joints that came between the two questions are no prediction.
    return session_->locate(asked_ns).map(
        [&](const openxr::Answers& again) { return openxr::Sampler::are_equal(again, *others); });
  }

  std::unique_ptr<openxr::Session> session_;
  openxr::Polls polls_;
  openxr::Sampler sampler_;
  std::int64_t age_ns_, predict_ns_;
  std::int64_t last_ns_ = 0;  ///< origin of the last sample
};

}  // namespace

Result<std::unique_ptr<PoseSource>> open_openxr(const config::Rig& rig, const calib::Calibration&,
                                                const Surroundings&) {
  const auto& settings = rig.pose.openxr;
  auto session = openxr::Session::open(settings, Deadline::in(kStart));
  if (!session) return fail_in("pose 'openxr'", session.error());
  log::info("pose 'openxr': {}", (*session)->name());
  const std::int64_t start_ns = now_ns();
  auto source = std::make_unique<OpenXrPose>(std::move(*session), settings, start_ns);
  const auto begun = source->begin(start_ns);
  if (!begun && begun.error().code == Errc::disconnected)
    return fail_in("pose 'openxr'", begun.error());
  return source;
}

Result<void> check_openxr(const config::Rig& rig, const calib::Calibration&, const Surroundings&) {
  const auto runtime = openxr::find_runtime(rig.pose.openxr.runtime);
  if (!runtime) return fail_in("pose 'openxr'", runtime.error());
  if (auto loads = openxr::check_library(*runtime); !loads)
    return fail_in("pose 'openxr'", loads.error());
  return {};
}

}  // namespace handcast::pose
