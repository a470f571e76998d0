// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "services/landmarks/detector.hpp"
#include "services/recording/about.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "services/recording/playback.hpp"
#include "services/runtime/loop.hpp"

namespace handcast::landmarks {
namespace fs = std::filesystem;
namespace {

using Track =
    std::vector<msg::HandLandmarks>;  ///< one hand over the recording; empty: not recorded

/// Replays recorded landmarks: returns those that are nearest to the image in time.
class ReplayDetector final : public Detector {
 public:
  ReplayDetector(std::array<Track, msg::kMaxHands> hands, timing::Loop loop)
      : hands_(std::move(hands)), loop_(std::move(loop)) {}

  Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints&,
                                Deadline deadline) override {
    const auto item = loop_.nearest(frame.header.origin_ns);
    if (!item) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, "the recording is over");
    }
    msg::Landmarks landmarks;
    landmarks.header = {frame.header.frame_id, frame.header.origin_ns, 0};
    for (const auto& hand : hands_)
      if (!hand.empty() && hand[item->index].presence > 0)
        landmarks.hands[landmarks.count++] = hand[item->index];
    return landmarks;
  }

 private:
  std::array<Track, msg::kMaxHands> hands_;
  timing::Loop loop_;
};

/// Plays the landmarks of a recording of `handcast record`, when they were published: with the
/// number and the origin of the image in which they were found, which was played before. One that a
/// busy machine could not deliver in time is delivered up to 10 ms late.
class RecordedDetector final : public Detector {
 public:
  RecordedDetector(recording::StreamReader reader, recording::Schedule schedule)
      : reader_(std::move(reader)), schedule_(std::move(schedule)) {}

  Result<msg::Landmarks> detect(const msg::CameraFrame&, const Hints&, Deadline deadline) override {
    constexpr std::int64_t kLate_ns = 10'000'000;
    const auto item = schedule_.at_or_after(std::max(now_ns() - kLate_ns, last_ns_ + 1));
    if (!item || item->due_ns > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, item ? "none before the deadline" : "the recording is over");
    }
    last_ns_ = item->due_ns;
    msg::Landmarks landmarks;
    if (auto read = reader_.read(item->index, landmarks); !read)
      return tl::make_unexpected(read.error());
    landmarks.header = {item->frame_id, item->origin_ns, 0};
    sleep_until_ns(item->due_ns);
    return landmarks;
  }

 private:
  recording::StreamReader reader_;
  recording::Schedule schedule_;
  std::int64_t last_ns_ = 0;  ///< when the last landmarks were due
};

Result<std::unique_ptr<Detector>> open_recorded(const Opening& with) {
  const auto& settings = with.settings.replay;
  auto reader = recording::StreamReader::open<msg::Landmarks>(
      settings.directory,
      recording::stream_of(settings.directory, config::name_at(with.at, "landmarks.hands"),
                           "landmarks.hands"));
  if (!reader) return tl::make_unexpected(reader.error());
  auto schedule =
      recording::Schedule::make(settings.directory, *reader, with.epoch_ns, settings.loop);
  if (!schedule) return tl::make_unexpected(schedule.error());
  return std::make_unique<RecordedDetector>(std::move(*reader), std::move(*schedule));
}

/// The hand at one time stamp: x, y and, if the recording has them, sigmas. A landmark whose
/// coordinates are not finite was not seen; a hand without a landmark is absent.
msg::HandLandmarks hand_at(const recording::Npy& array, std::size_t index, msg::Side side) {
  const std::size_t columns = array.shape[2];
  msg::HandLandmarks hand;
  hand.side = side;
  for (std::size_t i = 0; i < msg::kLandmarks; ++i) {
    const double* point = &array.values[(index * msg::kLandmarks + i) * columns];
    if (!std::isfinite(point[0]) || !std::isfinite(point[1])) continue;
    hand.points[i] = {static_cast<float>(point[0]), static_cast<float>(point[1]), 1,
                      columns == 3 ? static_cast<float>(point[2]) : 0.0f};
    hand.presence = 1;
  }
  return hand;
}

/// Why these cannot be landmarks in camera pixels. Empty if they can.
std::string fault_of_points(const recording::Npy& array) {
  constexpr double kFarthest_px = 1e5, kFraction = 1.5;
  const std::size_t columns = array.shape[2];
  double farthest = 0;
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    const double value = array.values[i];
    const bool is_sigma = i % columns == 2;
    const bool was_seen =
        is_sigma && std::isfinite(array.values[i - 1]) && std::isfinite(array.values[i - 2]);
    if (was_seen && !(value >= 0 && value < kFarthest_px))
      return fmt::format("the sigma of a landmark is {:g}", value);
    if (!is_sigma && std::isfinite(value)) farthest = std::max(farthest, std::abs(value));
  }
  if (farthest >= kFarthest_px)
    return fmt::format("a landmark is {:g} px away from the image", farthest);
  if (farthest > 0 && farthest < kFraction)
    return "its landmarks are within 1.5 px of the corner of the image; they must be in pixels, "
           "are they fractions of the image?";
  return {};
}

Result<Track> read_track(const fs::path& file, std::size_t count, msg::Side side) {
  const auto there = recording::is_there(file);
  if (!there) return tl::make_unexpected(there.error());
  if (!*there) return Track{};
  auto opened = recording::NpyFile::open(file);
  if (!opened) return tl::make_unexpected(opened.error());
  const auto has_columns = [&](std::size_t columns) {
    return opened->shape() == std::vector<std::size_t>{count, msg::kLandmarks, columns};
  };
  if (!has_columns(2) && !has_columns(3))
    return fail(Errc::bad_config, fmt::format("'{}' has the shape ({}); expected ({}, {}, 2) or, "
                                              "with sigmas, ({}, {}, 3), as many as "
                                              "landmarks_timestamps.npy",
                                              file.string(), fmt::join(opened->shape(), ", "),
                                              count, msg::kLandmarks, count, msg::kLandmarks));
  const auto array = opened->read();
  if (!array) return tl::make_unexpected(array.error());
  if (const auto fault = fault_of_points(*array); !fault.empty())
    return fail(Errc::bad_config, fmt::format("'{}': {}", file.string(), fault));
  Track track;
  for (std::size_t i = 0; i < count; ++i) track.push_back(hand_at(*array, i, side));
  return track;
}

}  // namespace

Result<std::unique_ptr<Detector>> open_replay(const Opening& with) {
  const auto& settings = with.settings.replay;
  const fs::path folder = settings.directory;
  if (folder.empty()) return fail(Errc::bad_config, "replay.directory names no folder");
  if (auto there = recording::check_folder(folder); !there)
    return tl::make_unexpected(there.error());
  if (recording::is_recording(folder)) return open_recorded(with);
  auto times_ns = recording::read_stamps_ns(folder / "landmarks_timestamps.npy");
  if (!times_ns) return tl::make_unexpected(times_ns.error());
  const auto stamps_ns = recording::read_all_stamps_ns(folder);
  if (!stamps_ns) return tl::make_unexpected(stamps_ns.error());

  std::array<Track, msg::kMaxHands> hands;
  for (const auto& [side, name] : {std::pair{msg::Side::left, "landmarks_left.npy"},
                                   {msg::Side::right, "landmarks_right.npy"}}) {
    auto track = read_track(folder / name, times_ns->size(), side);
    if (!track) return tl::make_unexpected(track.error());
    hands[static_cast<std::size_t>(side)] = std::move(*track);
  }
  if (hands[0].empty() && hands[1].empty())
    return fail(Errc::bad_config,
                fmt::format("'{}' holds neither landmarks_left.npy nor landmarks_right.npy",
                            folder.string()));
  auto loop = timing::Loop::make(std::move(*times_ns), timing::Lap::of(*stamps_ns), with.epoch_ns,
                                 settings.loop, timing::kLoneStep_ns);
  if (!loop) return fail_in("landmarks_timestamps.npy", loop.error());
  return std::make_unique<ReplayDetector>(std::move(hands), std::move(*loop));
}

}  // namespace handcast::landmarks
