// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "renderer/filter/landmark_track.hpp"
#include "renderer/filter/tracker_memory.hpp"
#include "renderer/ladder/gate.hpp"
#include "renderer/ladder/hindsight.hpp"
#include "renderer/ladder/rung.hpp"
#include "renderer/predict/hand_track.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {

/// One hand at the time of the photons, on its rung: it is drawn in its pose and then moved from P
/// onto Q̂.
struct Corrected {
  ProjectedPose posed;         ///< with P
  LandmarkPoints landmarks{};  ///< Q̂, or P if nothing corrects it
  bool has_landmarks = false;  ///< `landmarks` are Q̂, even if the rung leaves them at P
  bool is_alone = false;       ///< see Filtered::is_alone
  bool has_news = true;        ///< see Filtered::has_news

  Rung rung = Rung::landmarks;  ///< the rung of this frame, chosen or set
  /// The model by which the drawing is moved. Below `landmarks` only if that rung has the whole
  /// share of the light.
  Rung moves = Rung::landmarks;
  float registered = 1;  ///< share of late registration in the light, 0..1

  /// Q̂ - P.
  LandmarkPoints offset_px() const { return difference(landmarks, posed.landmarks); }
};

/// The ladder of one hand: collects the evidence, lets the gate choose the rung (or uses the one
/// that is set), and reduces the hand to that rung. See `docs/method.md#ladder`. One thread.
class HandLadder {
 public:
  /// Without evidence. Copies the settings.
  explicit HandLadder(const config::Cascade& settings);
  /// Uses other settings from now on, with the same evidence.
  void adjust(const config::Cascade& settings);

  /// Measures the error of Q̂ by a detection. Call it before LandmarkTrack::detection(), while Q̂
  /// does not depend on this detection.
  void detection(const HandTrack& track, std::int64_t origin_ns, const msg::HandLandmarks& seen);

  /// The hand for the frame at `target_ns`. `camera_ns`: exposure of the image that the frame can
  /// be registered to; empty if there is none. Call it once per frame.
  Corrected take(const HandTrack& track, std::int64_t target_ns,
                 std::optional<std::int64_t> camera_ns, const Predicted& predicted,
                 const Filtered& filtered);
  /// Late registration moved the landmarks of the frame for `target_ns` by `moved_px`, with its
  /// whole share (Corrected::registered == 1).
  void registered(std::int64_t target_ns, const LandmarkPoints& moved_px) {
    hindsight_.registered(target_ns, moved_px);
  }

 private:
  void judge_landmarks(Evidence& evidence) const;
  Rung choose(const HandTrack& track, std::int64_t target_ns, std::optional<std::int64_t> camera_ns,
              const Corrected& hand, const ProjectedPose& newest);
  void apply(const ProjectedPose& newest, Corrected& hand) const;

  config::Cascade settings_;
  bool automatic_;
  Rung fixed_;
  bool with_tracker_;  ///< Q̂ moves with P
  Gate gate_;
  RungBlend blend_;
  Hindsight hindsight_;
  std::array<RungModel, kRungs> models_{};  ///< of this frame; shift, similarity and fingers only
  std::optional<LandmarkPoints> offset_;    ///< Q̂ - P of the last frame
  /// Mean square difference of detections from P + offset_, or from lit_; smoothed.
  std::optional<float> innovation_px2_;
  /// Q̂ of recent frames, if Q̂ does not move with P.
  TrackerMemory lit_;
  /// Mean square difference of detections from P, if Q̂ does not move with P; smoothed.
  std::optional<float> tracker_px2_;
};

}  // namespace handcast::renderer
