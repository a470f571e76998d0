// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "services/landmarks/geometry/points.hpp"

namespace handcast::landmarks {

/// Moves a network's landmarks (Q) to where the tracker defines its joints (P): the wrist, the
/// lower joints of the thumb and the knuckles of the two are different places of a hand. Offsets
/// are measured in the hand's own 2-D frame in palm lengths: x along the palm, from wrist to middle
/// knuckle; y across it, from the little finger's side to the index finger's. So one table serves
/// both hands, seen from either side.
///
/// Only Q - P can be observed: the offset plus the tracker's error. On a hand at rest no average
/// separates the two, and offsets learnt from all of Q - P would copy into Q the error that the
/// cascade is to correct. Therefore
///  - tips and the two joints below them have no offset;
///  - the others start from a table of what is certain, which is the thumb's knuckle;
///  - they learn only the part of Q - P that no similarity of the other points explains, only while
///    the hand rests, with the time constant kLearning_s, and stay within kReach of the table.
///
/// One object per hand. One thread.
class JointConventionOffsets {
 public:
  static constexpr float kLearning_s = 60;  ///< time constant of the learning
  static constexpr float kReach = 0.06f;    ///< largest learnt change of an offset, in palm lengths

  /// The network's points, moved to the tracker's joints.
  Points to_tracker(const Points& network_px) const;

  /// Learns from one hand as the network and the tracker see it at `time_ns`.
  void learn(std::int64_t time_ns, const Points& network_px, const Points& tracker_px);

  /// The offsets of all points in the hand's frame, in palm lengths.
  const Points& offsets() const { return offsets_; }

 private:
  bool rests(std::int64_t time_ns, const Points& tracker_px);

  Points offsets_ = table();
  Points rest_px_{};
  std::int64_t rest_since_ns_ = 0, learnt_ns_ = 0;

  static const Points& table();
};

/// What remains of Q - P after the similarity that best aligns the points without an offset, in the
/// hand's frame of Q. Empty if the hand is too small in the image to measure it.
std::optional<Points> convention_residual(const Points& network_px, const Points& tracker_px);

}  // namespace handcast::landmarks
