// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/pose/stereo/pairing.hpp"
#include "services/pose/stereo/side_evidence.hpp"
#include "services/pose/stereo/stereo_hand.hpp"

namespace handcast::pose::stereo {

/// The landmarks of the views that belong together; null: this view has none.
using Seen = std::array<const msg::Landmarks*, kViews>;
/// Refers to the landmarks of a pair, which must outlive it.
Seen seen_of(const Pair& pair);

/// Step "stereo": both hands from the landmarks of two views. A function of the messages and their
/// times. One thread.
class StereoTracker {
 public:
  /// Loads the hand models of the rig. Errors: those of load_hand_or_default().
  static Result<StereoTracker> open(const config::Rig& rig, const Views& views,
                                    const glm::dmat4& tracker_from_first);

  /// The hands in tracker space, at the time of the newer image, whose origin they have. Hands that
  /// cannot be followed are left out. The frame ids count the samples.
  msg::HandPoses sample(const Seen& seen);

  /// Where the hands are expected in a view at `time_ns`, by msg::Side: hints for a detector.
  std::array<Expected, msg::kMaxHands> expected(std::int64_t time_ns) const;

  /// How often a hand has been compared with the models of both sides.
  std::uint64_t comparisons() const { return comparisons_; }

 private:
  explicit StereoTracker(const Views& views, const std::array<StereoHand, msg::kMaxHands>& hands)
      : views_(views), hands_(hands) {}

  using HandLooks = std::array<Looks, msg::kMaxHands>;  ///< by msg::Side
  bool settle_sides(std::int64_t time_ns, HandLooks& looks);

  Views views_;
  std::array<StereoHand, msg::kMaxHands> hands_;       ///< by msg::Side
  std::array<SideEvidence, msg::kMaxHands> evidence_;  ///< that they are the other ones
  std::uint64_t samples_ = 0, comparisons_ = 0;
};

}  // namespace handcast::pose::stereo
