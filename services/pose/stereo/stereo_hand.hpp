// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "config/sections/stereo.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/pose/stereo/hand_track.hpp"
#include "services/pose/stereo/match.hpp"

namespace handcast::pose::stereo {

/// What one view sees of a hand.
struct Look {
  ReportedHand hand;         ///< the report
  std::int64_t time_ns = 0;  ///< of its image
};
/// By view; empty: it does not see the hand.
using Looks = std::array<std::optional<Look>, kViews>;

/// One hand of the person, and its state: see `docs/method.md#stereo`. One thread.
class StereoHand {
 public:
  /// After so long without landmarks the hand is found anew.
  static constexpr std::int64_t kForget_ns = 300'000'000;
  /// Other postures that are tried now and then: mirrored in depth, fingers at rest.
  static constexpr int kAlternatives = 2;

  /// `hand`: the model of this side. `tracker_from_first`: from the first camera to tracker space.
  StereoHand(const renderer::HandMesh& hand, const config::PoseStereo& settings, const Views& views,
             const glm::dmat4& tracker_from_first);

  /// The joints that are expected, in the space of the first camera; empty if the hand is not
  /// followed at that time.
  std::optional<PosedHand> expected(std::int64_t time_ns) const;

  /// The pose in tracker space at `time_ns`, the time of the newest look. Looks at other times are
  /// moved there as the hand moves. Empty if no look can be used, the time is not later than that
  /// of the last pose, or no hand can have these landmarks. A hand that only one view has seen for
  /// longer than settings.one_view_s begins anew.
  std::optional<msg::HandPose> follow(std::int64_t time_ns, const Looks& looks);
  /// The pose at `time_ns` of a hand that no view can see, as it is expected to go on. Its
  /// confidence falls to 0 at kForget_ns after the last look; it is empty from then on.
  std::optional<msg::HandPose> predict(std::int64_t time_ns) const;

  /// How badly these looks fit a hand of this side of which nothing is known, as HandFit::cost; not
  /// worse than as the hand is followed. Empty if not both views see nearly all of it.
  std::optional<double> cost_anew(const Looks& looks) const;
  /// Follows the hand no longer.
  void forget();

  /// The model of this side.
  const Skeleton& skeleton() const { return skeleton_; }

 private:
  bool begin(const SeenInViews& seen);
  void go_on(std::int64_t time_ns, const Looks& looks, double step_s);
  void try_another(const SeenInViews& seen);
  SeenInViews moved_to(std::int64_t time_ns, const HandState& now, const Looks& looks) const;
  bool is_followed(std::int64_t time_ns) const;
  double confidence_of(const Looks& looks) const;
  msg::HandPose pose_of(const HandState& state, double confidence) const;

  Skeleton skeleton_;
  msg::Side side_;
  Views views_;
  glm::dmat4 tracker_from_first_;
  HandPrior people_;  ///< bones of a person of whom nothing is known
  std::int64_t one_view_ns_;
  std::optional<HandTrack> track_;
  std::int64_t last_ns_ = 0;       ///< of the last fit
  std::int64_t last_both_ns_ = 0;  ///< of the last fit of both views, or of the first
  double confidence_ = 0;          ///< of the last pose
  double sigmas_ = 1;              ///< residuals of the fits, smoothed
  bool is_whole_ = false;          ///< both views have seen it since begin()
  int images_ = 0;                 ///< since begin()
  /// For each alternative: trials in a row in which it was better.
  std::array<int, kAlternatives> better_{};
};

}  // namespace handcast::pose::stereo
