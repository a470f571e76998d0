// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "ipc/msg/guest_streams.hpp"
#include "ipc/msg/same_calibration.hpp"
#include "ipc/msg/tracker_faults.hpp"
#include "ipc/ring/reader.hpp"
#include "services/pose/drift/calibration_watch.hpp"
#include "services/pose/pose_source.hpp"
#include "services/runtime/context.hpp"

namespace handcast::pose {
namespace {

/// The landmarks of the cameras, on their way to a source. One thread.
class LandmarkFeed {
 public:
  using Ring = Result<ipc::Reader<msg::Landmarks>>;

  /// `rings`: landmarks.hands and landmarks2.hands. `calibration`: the id of the rig's; landmarks
  /// of another one are not passed on.
  LandmarkFeed(std::array<Ring, kMostViews> rings, std::uint32_t calibration)
      : rings_(std::move(rings)), calibration_(calibration) {}

  /// Passes what has arrived to the source. If it needs landmarks, waits for them: 50 ms, or with
  /// two views 2 ms for the awaited one. Errors: timeout (nothing arrived, which is no fault: the
  /// first landmarks come after the service is ready), bad_data (another calibration), those of
  /// the ring.
  Result<void> pass_on(PoseSource& source);
  /// The next landmarks of the first view that were not read yet; empty if there are none.
  std::optional<msg::Landmarks> next();

 private:
  Result<void> pass_on(PoseSource& source, int view, Deadline deadline);

  std::array<Ring, kMostViews> rings_;
  std::uint32_t calibration_;
};

using namespace std::chrono_literals;

Result<void> LandmarkFeed::pass_on(PoseSource& source) {
  if (source.views() == 1)
    return pass_on(source, 0, source.needs_landmarks() ? Deadline::in(50ms) : Deadline::now());
  // The landmarks of the other view are taken at most so late.
  constexpr auto kOtherView = 2ms;
  const int awaited = source.awaited_view();
  auto first = pass_on(source, awaited,
                       source.needs_landmarks() ? Deadline::in(kOtherView) : Deadline::now());
  if (!first && first.error().code != Errc::timeout) return first;
  auto other = pass_on(source, 1 - awaited, Deadline::now());
  if (!other && other.error().code != Errc::timeout) return other;
  return {};
}

Result<void> LandmarkFeed::pass_on(PoseSource& source, int view, Deadline deadline) {
  auto& ring = rings_[static_cast<std::size_t>(view)];
  if (!ring) return tl::make_unexpected(ring.error());
  const auto seen = ring->latest(deadline);
  if (!seen) return tl::make_unexpected(seen.error());
  if (auto ours = msg::check_calibration(**seen, calibration_); !ours) return ours;
  source.see(**seen, view);
  return {};
}

std::optional<msg::Landmarks> LandmarkFeed::next() {
  if (!rings_.front()) return std::nullopt;
  const auto seen = rings_.front()->next(Deadline::now());
  return seen ? std::optional(**seen) : std::nullopt;
}

}  // namespace

}  // namespace handcast::pose

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

constexpr auto kSilence = 50ms;  ///< no sample for so long is worth a word

/// How long a source may wait for its next sample. One that also takes landmarks must soon get the
/// next ones; one of two views has been waited for already.
static Deadline turn_of(const pose::PoseSource& source) {
  if (source.views() == 0 || (source.needs_landmarks() && source.views() == 1))
    return Deadline::in(kSilence);
  return source.needs_landmarks() ? Deadline::now() : Deadline::in(5ms);
}

/// Compares a sample of the tracker, and all landmarks that have come, with the calibration.
static void watch_calibration(const msg::HandPoses& poses, pose::LandmarkFeed& landmarks,
                              pose::CalibrationWatch& watch, pose::DriftLog& log) {
  while (const auto seen = landmarks.next()) watch.see(*seen);
  watch.see(poses);
  log.tell(watch.drift());
}

/// Publishes the samples of the hand tracker to the ring pose.hands, also those without a hand, so
/// that readers see that the tracker works.
static void run_pose(service::Context& context) {
  if (pose::is_exclusive(context.rig().pose)) context.stand_by();
  const auto source =
      must(pose::open_pose_source(context.rig(), context.calibration(), context.epoch_ns(),
                                  [&](std::string_view stream) { return context.ring(stream); }));
  context.stand_by();
  pose::LandmarkFeed landmarks({context.reader<msg::Landmarks>("landmarks.hands"),
                                context.reader<msg::Landmarks>("landmarks2.hands")},
                               context.calibration().id);
  auto hands = must(context.writer<msg::HandPoses>("pose.hands"));
  pose::CalibrationWatch watch(context.rig().pose.drift, context.calibration());
  pose::DriftLog drift_log;

  const auto live = source->is_adjustable() ? must(context.live_settings()) : nullptr;
  context.ready();
  auto sampled_ns = now_ns();
  while (context.running()) {
    service::pass_on(live.get(), *source);
    if (source->views() > 0)
      if (const auto passed = landmarks.pass_on(*source); !passed) {
        if (passed.error().code != Errc::timeout) context.tolerate(passed.error());
        if (source->needs_landmarks()) continue;
      }
    msg::HandPoses poses;
    if (const auto sampled = source->sample(poses, turn_of(*source)); !sampled) {
      if (sampled.error().code != Errc::timeout || now_ns() - sampled_ns > to_ns(kSilence))
        context.tolerate(sampled.error());
      continue;
    }
    sampled_ns = now_ns();
    poses.calibration = source->depends_on_calibration() ? context.calibration().id : 0;
    hands.publish(poses);
    // A pose that the tracker predicted is of the future.
    const auto end_ns = now_ns(), begin_ns = std::min(poses.header.origin_ns, end_ns);
    std::vector<msg::StageMark> marks{
        {msg::Stage::sample, msg::detail_of(source->take_faults()), begin_ns, end_ns}};
    if (watch.is_on() && source->views() == 0) {
      watch_calibration(poses, landmarks, watch, drift_log);
      marks.push_back({msg::Stage::watch, msg::detail_of(watch.note()), end_ns, now_ns()});
    }
    context.mark(poses.header, marks);
  }
}

static Result<void> check_pose(const config::Rig& rig, const calib::Calibration& calibration) {
  return pose::check_pose_sources(rig, calibration);
}

int main(int argc, char** argv) {
  return service::run(
      {.name = "pose",
       .summary = "Delivers the hand poses of the tracker.",
       .paced_by = "its device",
       .publishes = {"pose.hands"},
       .subscribes = {"landmarks.hands", "landmarks2.hands", std::string(msg::kGuestPoses)},
       .settings = {"pose.second", "pose.handover", "pose.drift"},
       .backends = service::describe_rows(pose::pose_backends())},
      argc, argv, run_pose, check_pose);
}
