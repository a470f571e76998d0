// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/estimate/abruptness.hpp"
#include "renderer/estimate/hand_errors.hpp"
#include "renderer/estimate/landmark_rest.hpp"
#include "renderer/predict/hand_track.hpp"

namespace handcast::renderer {

class KnownErrors;
struct HandJoints;

/// Step "estimate" and its state: the most likely hand, given the samples of the tracker and the
/// landmarks of the images. What is wrong with the tracker's hand is estimated, because it changes
/// slowly while the hand moves fast. See `docs/method.md#estimate`. One thread.
class HandEstimate {
 public:
  /// Nothing is known yet. Copies the calibration.
  explicit HandEstimate(const calib::Calibration& calibration);
  ~HandEstimate();
  HandEstimate(HandEstimate&&) noexcept;
  HandEstimate& operator=(HandEstimate&&) noexcept;

  /// Adds the landmarks of an image. They wait for a sample of the tracker that is not older:
  /// it shows where the tracker saw the hand at the exposure. Those that come within 9 ms of others
  /// are not used.
  void detection(std::int64_t origin_ns, const msg::HandLandmarks& seen);
  /// Uses the landmarks that wait, once `track` has that sample. After a jump of the tracker they
  /// are dropped.
  void look_back(const HandTrack& track);

  /// The tracker has jumped: where it puts the hand from now on is not known until landmarks show
  /// it.
  void tracker_jumped();

  /// True once landmarks were used, unless the newest ones contradict the tracker.
  bool knows() const;
  /// Since when the hand has been where it is, and whether it rests there.
  HandTrack::Rest rest() const { return {explained_ns_, knows() ? rest_share_ : 0}; }
  /// The tracker's hand at a time without its errors. What is known only for a moment fades after
  /// the newest landmarks.
  msg::HandPose corrected(std::int64_t time_ns, const msg::HandPose& reported) const;
  /// The tracker's errors at a time.
  HandErrors errors_at(std::int64_t time_ns) const;

 private:
  struct Waiting {
    std::int64_t origin_ns;
    msg::HandLandmarks seen;
  };

  LandmarkPoints landmarks_px(const HandJoints& reported) const;

  calib::Calibration calibration_;
  std::unique_ptr<KnownErrors> known_;
  /// Exposure of the newest landmarks, and of the newest that do not contradict the tracker; 0:
  /// none, since it jumped.
  /// @{
  std::int64_t last_ns_ = 0, explained_ns_ = 0;
  /// @}
  Abruptness abruptness_;
  LandmarkRest rest_;
  float rest_share_ = 0;  ///< of the newest landmarks
  std::optional<Waiting> waiting_;
};

}  // namespace handcast::renderer
