// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "renderer/filter/filters.hpp"
#include "renderer/filter/landmark_track.hpp"
#include "renderer/ladder/corrected.hpp"
#include "renderer/ladder/gate.hpp"
#include "renderer/ladder/hindsight.hpp"
#include "renderer/predict/hand_track.hpp"

namespace handcast::renderer {

/// The ladder of one hand: gathers the evidence, asks the gate (or holds the rung that is set) and
/// takes the hand back to that rung.
class HandLadder {
 public:
  explicit HandLadder(const config::Cascade& settings);

  /// Before the hand's track hears of it: what Q̂ is off by shows in what the next detection says.
  void detection(const HandTrack& track, std::int64_t origin_ns, const msg::HandLandmarks& seen);

  /// Once a frame. `camera_ns`: when the image was taken that the frame can be registered to; empty
  /// if there is none.
  Corrected take(const HandTrack& track, std::int64_t target_ns,
                 std::optional<std::int64_t> camera_ns, const Predicted& predicted,
                 const Filtered& filtered);
  /// Late registration, wholly in the light, moved the landmarks of the frame for `target_ns` by so
  /// much.
  void registered(std::int64_t target_ns, const LandmarkPoints& moved_px) {
    hindsight_.registered(target_ns, moved_px);
  }

 private:
  /// The newest tracker sample, as it is.
  struct Newest {
    msg::HandPose pose;
    LandmarkPoints tracker;
  };
  void judge_landmarks(Evidence& evidence) const;
  std::optional<Newest> newest(const HandTrack& track) const;
  Rung choose(const HandTrack& track, std::int64_t target_ns, std::optional<std::int64_t> camera_ns,
              const Corrected& hand, const Newest& newest);
  void apply(const Newest& newest, Corrected& hand) const;

  config::Cascade settings_;
  bool automatic_;
  Rung fixed_;
  bool with_tracker_;  ///< Q̂ moves with P
  Gate gate_;
  RungBlend blend_;
  Hindsight hindsight_;
  std::array<RungModel, kRungs> models_{};  ///< of this frame; shift, similarity and fingers only
  std::optional<LandmarkPoints> offset_;    ///< Q̂ - P of the last frame
  std::optional<float>
      innovation_px2_;  ///< what detections differed by from P + offset, or from lit_; smoothed
  TrackerMemory lit_;   ///< Q̂ as it was lit, where it does not move with P
  std::optional<float> tracker_px2_;  ///< likewise: what detections differed by from P
};

}  // namespace handcast::renderer
