// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "ipc/msg/hand_poses.hpp"
#include "services/landmarks/finder/region.hpp"

namespace handcast::landmarks {

/// The network's points and the tracker's joints are not all the same places of a hand.
/// Differences, per landmark, in the hand's own 2-D frame: along from wrist to middle knuckle,
/// across from the little finger's side to the index finger's, in palm lengths. So one table serves
/// both hands, seen from either side.
///
/// What can be known: only Q - P = definition + error of the tracker is seen, and on a hand that
/// rests no average tells the two apart. What all of that were learnt would copy the tracker's
/// error into Q, which the cascade is to remove. So
///  - tips and the two joints below them are taken as defined alike: their offset is 0 for ever;
///  - for wrist, thumb's lower joints and knuckles there is a table, measured once, of what is
///  certain: the thumb's knuckle;
///  - only that part of Q - P is learnt which no shift, turn and scale of the other points
///  explains, only while the hand rests, with a
///    time constant of kLearning_s and never further than kReach from the table. Before: the table
///    alone.
class JointConventionOffsets {
 public:
  static constexpr float kLearning_s = 60, kReach = 0.06f;

  /// Moves the network's points to where the tracker's joints are defined.
  Points to_tracker(const Points& network_px) const;

  /// A hand as the network (Q) and the tracker (P) see it at the same time.
  void learn(std::int64_t time_ns, const Points& network_px, const Points& tracker_px);

  const Points& offsets() const { return offsets_; }

 private:
  bool rests(std::int64_t time_ns, const Points& tracker_px);

  Points offsets_ = table();
  Points rest_px_{};
  std::int64_t rest_since_ns_ = 0, learnt_ns_ = 0;

  static const Points& table();
};

/// The difference Q - P of each point that is left when the points defined alike are laid upon each
/// other by a similarity, in the hand's frame of Q; nothing where the hand is too small to tell.
std::optional<Points> definition_residual(const Points& network_px, const Points& tracker_px);

}  // namespace handcast::landmarks
