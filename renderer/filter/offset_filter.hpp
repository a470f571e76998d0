// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "renderer/filter/filters.hpp"
#include "renderer/filter/finger_faults.hpp"
#include "renderer/filter/landmark_filter.hpp"
#include "renderer/filter/point_track.hpp"
#include "renderer/filter/shared_offset.hpp"
#include "renderer/filter/tracker_memory.hpp"

namespace handcast::renderer {

/// The landmarks of one hand filtered without the tracker, each by a PointTrack. Less exact than
/// with the tracker, but valid while it is silent, and an independent estimate if the two disagree.
class LandmarksAlone {
 public:
  /// Without detections. Uses motion_process and noise_px.
  explicit LandmarksAlone(const config::Filter& settings);

  /// Adds a detection. One more than 80 ms after the last restarts the tracks.
  void detection(std::int64_t origin_ns, const msg::HandLandmarks& seen);

  /// True if a landmark is known and the newest detection is at most 80 ms older than `time_ns`.
  bool fresh(std::int64_t time_ns) const;
  /// Origin of the newest detection; 0 if there is none.
  std::int64_t newest_ns() const { return newest_ns_; }
  /// True if landmark `i` has been seen.
  bool known(int i) const { return tracks_[i].known(); }
  /// Position of landmark `i` at `time_ns`, undistorted camera px; valid if known(i).
  glm::vec2 at(int i, std::int64_t time_ns) const { return tracks_[i].at(time_ns); }
  /// Drops all detections.
  void forget();

 private:
  PointTrack::Model model_;
  std::int64_t newest_ns_ = 0;
  std::array<PointTrack, kLandmarks> tracks_{};
};

/// A filter that tracks the offset Q - P of each point at the time of the detection and adds it to
/// P at the target time. While the tracker is silent, Q̂ is that of LandmarksAlone; after the
/// tracker has jumped or returned, the offsets restart from there. `Track` is the state of one
/// point: it has known() and forget(), and is used by the virtual functions below.
template <class Track>
class OffsetFilter : public CarryFilter {
 public:
  /// Without detections. Copies the settings.
  explicit OffsetFilter(const config::Filter& settings) : settings_(settings), alone_(settings) {}

  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& reported,
                 const TrackerAt& tracker) override {
    const auto then = tracker_then(tracker, settings_.hindsight ? nullptr : &memory_, origin_ns);
    const bool with_tracker = then && !silent_ && !jumped_;
    const auto expected =
        with_tracker ? expected_with(*then, origin_ns) : expected_alone(origin_ns);
    const auto common = with_tracker ? expected_in_common(*then, origin_ns) : ExpectedPoints{};
    const auto seen = order_.mended(origin_ns, reported, expected, common);
    if (with_tracker && ++compared_ > kGuessed && contradicted(origin_ns, seen, expected)) {
      doubted_until_ns_ = origin_ns + kDoubt_ns;
      jumped_ = true;
    }
    FingerSteps::Verdicts verdicts{};
    if (with_tracker && !jumped_)
      verdicts = steps_.judge(origin_ns, seen, expected, common, expected_alone(origin_ns));
    alone_.detection(origin_ns, seen);
    sigmas_.detection(seen);
    if (!then || silent_ || origin_ns < doubted_until_ns_) return;
    for (int i = 0; i < kLandmarks; ++i)
      if (was_seen(seen.points[i]))
        take(i == 0 ? FingerSteps::Verdict::usual : verdicts[finger_of_landmark(i)], tracks_[i],
             origin_ns, position_px(seen.points[i]) - (*then)[i]);
  }

  void tracker_is(Tracker state) override { silent_ = state == Tracker::silent; }
  void tracker_jumped() override { jumped_ = true; }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns,
                                   const LandmarkPoints& tracker) override {
    if (!settings_.hindsight) memory_.remember(target_ns, tracker);
    const bool alone = (silent_ || target_ns < doubted_until_ns_) && alone_.fresh(target_ns);
    if (!alone && (jumped_ || (silent_ && was_alone_)))
      begin_anew(target_ns, tracker, alone_.fresh(target_ns) || was_alone_);
    was_alone_ = alone;
    std::array<glm::vec2, kLandmarks> offsets{};
    std::array<bool, kLandmarks> known{};
    for (int i = 0; i < kLandmarks; ++i) {
      known[i] = alone ? alone_.known(i) : tracks_[i].known();
      if (known[i])
        offsets[i] =
            alone ? alone_.at(i, target_ns) - tracker[i] : offset_at(tracks_[i], target_ns);
    }
    if (!alone) shrink_to_shared(offsets, known, sigmas_.px(), tracker);
    return moved_by(tracker, offsets, known);
  }

  void forget() override {
    forget_offsets();
    alone_.forget();
    sigmas_.forget();
  }

 protected:
  /// Adds an offset measured at `time_ns`.
  virtual void update(Track& track, std::int64_t time_ns, glm::vec2 offset_px) const = 0;
  /// The offset at `time_ns`, camera px.
  virtual glm::vec2 offset_at(const Track& track, std::int64_t time_ns) const = 0;
  /// Restarts the track from an offset that is a guess.
  virtual void begin(Track& track, std::int64_t time_ns, glm::vec2 offset_px) const = 0;
  /// The settings given to the constructor.
  const config::Filter& settings() const { return settings_; }

 private:
  /// The tracker is not used for this long after the landmarks contradicted it.
  static constexpr std::int64_t kDoubt_ns = 100'000'000;
  /// An offset is a guess until this many detections have been compared with it.
  static constexpr int kGuessed = 2;
  /// The landmarks contradict the tracker beyond this error, plus the drift since the last
  /// detection.
  static constexpr float kDisagreement_px = 10, kDrift_px_s = 100;

  void take(FingerSteps::Verdict verdict, Track& track, std::int64_t time_ns, glm::vec2 offset_px) {
    if (verdict == FingerSteps::Verdict::usual) update(track, time_ns, offset_px);
    if (verdict == FingerSteps::Verdict::anew) begin(track, time_ns, offset_px);
  }

  void forget_offsets() {
    for (Track& track : tracks_) track.forget();
  }

  ExpectedPoints expected_with(const LandmarkPoints& then, std::int64_t origin_ns) const {
    ExpectedPoints expected;
    for (int i = 0; i < kLandmarks; ++i) {
      expected.known[i] = tracks_[i].known();
      if (expected.known[i]) expected.px[i] = then[i] + offset_at(tracks_[i], origin_ns);
    }
    return expected;
  }

  /// By the medians of the offsets, which a wrong finger does not move.
  ExpectedPoints expected_in_common(const LandmarkPoints& then, std::int64_t origin_ns) const {
    std::array<glm::vec2, kLandmarks> offsets_px;
    std::size_t count = 0;
    for (const Track& track : tracks_)
      if (track.known()) offsets_px[count++] = offset_at(track, origin_ns);
    ExpectedPoints expected;
    if (count == 0) return expected;
    const glm::vec2 median_px = median_of(std::span(offsets_px).first(count));
    for (int i = 0; i < kLandmarks; ++i) expected.px[i] = then[i] + median_px;
    expected.known.fill(true);
    return expected;
  }

  ExpectedPoints expected_alone(std::int64_t origin_ns) const {
    ExpectedPoints expected;
    for (int i = 0; i < kLandmarks; ++i) {
      expected.known[i] = alone_.known(i) && alone_.fresh(origin_ns);
      if (expected.known[i]) expected.px[i] = alone_.at(i, origin_ns);
    }
    return expected;
  }

  /// Returns true if the landmarks as a whole continue their own motion but not that of the
  /// tracker: the tracker has jumped or is frozen.
  bool contradicted(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                    const ExpectedPoints& with_tracker) const {
    const std::int64_t since_ns = origin_ns - alone_.newest_ns();
    if (!alone_.fresh(origin_ns) || since_ns <= 0) return false;
    const float with_px = common_error_px(seen, with_tracker),
                alone_px = common_error_px(seen, expected_alone(origin_ns));
    const float limit_px = kDisagreement_px + kDrift_px_s * static_cast<float>(since_ns) * 1e-9f;
    return with_px > limit_px && alone_px < 0.5f * with_px;
  }

  /// Restarts the offsets after a jump of P. `landmarks_known`: LandmarksAlone has the position of
  /// the hand. Otherwise the offsets from before the jump are kept, unless they are relative to a
  /// hand that was held while the tracker was silent.
  void begin_anew(std::int64_t target_ns, const LandmarkPoints& tracker, bool landmarks_known) {
    if (landmarks_known)
      for (int i = 0; i < kLandmarks; ++i)
        if (alone_.known(i))
          begin(tracks_[i], alone_.newest_ns(), alone_.at(i, target_ns) - tracker[i]);
    if (!landmarks_known && held_) forget_offsets();
    held_ = silent_;
    jumped_ = false;
    compared_ = 0;
  }

  config::Filter settings_;
  TrackerMemory memory_;
  FingerOrder order_;
  FingerSteps steps_;
  LandmarksAlone alone_;
  LandmarkSigmas sigmas_;
  bool silent_ = false;
  std::int64_t doubted_until_ns_ = 0;
  int compared_ = 0;        ///< detections since the offsets were restarted
  bool jumped_ = false;     ///< the tracker has jumped; the offsets are from before
  bool was_alone_ = false;  ///< the last at() used LandmarksAlone
  bool held_ = false;       ///< the offsets are relative to a hand that was held, not tracked
  std::array<Track, kLandmarks> tracks_{};
};

}  // namespace handcast::renderer
