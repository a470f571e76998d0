// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/pose/pose_source.hpp"
#include "services/recording/about.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "services/recording/playback.hpp"
#include "services/runtime/loop.hpp"

namespace handcast::pose {
namespace {

/// Plays a recording at its original speed. Each sample is delivered at its own time, so its age is
/// 0.
class ReplayPose final : public PoseSource {
 public:
  ReplayPose(recording::RecordedHands recording, timing::Loop loop)
      : recording_(std::move(recording)), loop_(std::move(loop)) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    const auto item = loop_.at_or_after(std::max(now_ns(), last_ns_ + 1));
    if (!item || item->due_ns > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, item ? "pose 'replay': no sample before the deadline"
                                      : "pose 'replay': the recording is over");
    }
    sleep_until_ns(item->due_ns);
    last_ns_ = item->due_ns;
    poses = {};
    poses.header.frame_id = item->number;
    poses.header.origin_ns = item->due_ns;
    for (const auto& hand : recording_.hands)
      if (!hand.empty()) poses.hands[poses.count++] = hand[item->index];
    return {};
  }

  /// The recording has no widths; those of the mean hand are put in their place.
  joints::Conventions conventions() const override {
    auto recorded = joints::kLeap;
    recorded.radii = joints::Radii::model;
    return recorded;
  }

 private:
  recording::RecordedHands recording_;
  timing::Loop loop_;
  std::int64_t last_ns_ = 0;
};

/// Plays the samples of a recording of `handcast record`, when they were published. One that a busy
/// machine could not deliver in time is delivered up to 10 ms late.
class RecordedPose final : public PoseSource {
 public:
  RecordedPose(recording::StreamReader reader, recording::Schedule schedule)
      : reader_(std::move(reader)), schedule_(std::move(schedule)) {}

  Result<void> sample(msg::HandPoses& poses, Deadline deadline) override {
    constexpr std::int64_t kLate_ns = 10'000'000;
    const auto item = schedule_.at_or_after(std::max(now_ns() - kLate_ns, last_ns_ + 1));
    if (!item || item->due_ns > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, item ? "pose 'replay': no sample before the deadline"
                                      : "pose 'replay': the recording is over");
    }
    last_ns_ = item->due_ns;
    if (auto read = reader_.read(item->index, poses); !read)
      return fail_in("pose 'replay'", read.error());
    poses.header = {item->frame_id, item->origin_ns, 0};
    sleep_until_ns(item->due_ns);
    return {};
  }

  joints::Conventions conventions() const override {
    return {.place = joints::Place::as_recorded,
            .has_measured_palm = true,
            .radii = joints::Radii::as_recorded};
  }

 private:
  recording::StreamReader reader_;
  recording::Schedule schedule_;
  std::int64_t last_ns_ = 0;  ///< when the last sample was due
};

Result<std::unique_ptr<PoseSource>> open_recorded(const config::Replay& settings,
                                                  std::int64_t epoch_ns) {
  auto reader = recording::StreamReader::open<msg::HandPoses>(settings.directory, "pose.hands");
  if (!reader) return fail_in("pose 'replay'", reader.error());
  auto schedule = recording::Schedule::make(settings.directory, *reader, epoch_ns, settings.loop);
  if (!schedule) return fail_in("pose 'replay'", schedule.error());
  return std::make_unique<RecordedPose>(std::move(*reader), std::move(*schedule));
}

}  // namespace

Result<std::unique_ptr<PoseSource>> open_replay(const config::Rig& rig, const calib::Calibration&,
                                                const Surroundings& around) {
  const auto& settings = rig.pose.replay;
  if (settings.directory.empty())
    return fail(Errc::bad_config, "pose 'replay': no folder is given; set pose.replay.directory");
  if (auto there = recording::check_folder(settings.directory); !there)
    return fail_in("pose 'replay'", there.error());
  if (recording::is_recording(settings.directory)) return open_recorded(settings, around.epoch_ns);
  auto recording = recording::read_recording(settings.directory);
  if (!recording) return fail_in("pose 'replay'", recording.error());
  const auto stamps_ns = recording::read_all_stamps_ns(settings.directory);
  if (!stamps_ns) return fail_in("pose 'replay'", stamps_ns.error());
  auto times_ns = recording->time_ns;
  for (auto& time_ns : times_ns) time_ns += recording->first_ns;
  auto loop = timing::Loop::make(std::move(times_ns), timing::Lap::of(*stamps_ns), around.epoch_ns,
                                 settings.loop, timing::kLoneStep_ns);
  if (!loop) return fail_in("pose 'replay': timestamps.npy", loop.error());
  return std::make_unique<ReplayPose>(std::move(*recording), std::move(*loop));
}

}  // namespace handcast::pose
