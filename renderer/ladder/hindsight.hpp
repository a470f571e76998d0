// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <optional>

#include "renderer/predict/hand_track.hpp"

namespace handcast::renderer {

/// What the light was off by because the hand moved, measured: once the tracker has told where the
/// hand was at the time a frame was drawn for, the frame's prediction is compared with it.
class Hindsight {
 public:
  /// RMS over the landmarks, camera px; its mean over some 100 ms where it grows, over some 300 ms
  /// where it falls (gestures come in bursts). Not its mean square: that is made by the few moments
  /// in which every rung is far off, and hides how they differ in the others.
  struct Motion {
    float hold_px = 0;     ///< of the newest sample as it was
    float predict_px = 0;  ///< of its prediction for the light
    /// Of that prediction, registered to the newest image. Where it was, that is measured. Where it
    /// was not, it is reckoned: an image would have shown how the prediction for its own time was
    /// shifted, turned and scaled.
    float register_px = 0;
  };

  /// A frame for the light of `target_ns`, which shows an image taken at `camera_ns`.
  struct Frame {
    std::int64_t target_ns = 0, camera_ns = 0, newest_ns = 0;
    LandmarkPoints newest{}, at_camera{},
        at_target{};  ///< P of the newest sample and at the two times, as known then
    std::optional<LandmarkPoints> registered;  ///< what registration moved at_target by
  };

  /// True where remember() is to be called for this frame: not all are needed.
  bool wants(std::int64_t target_ns) const;
  void remember(const Frame& frame);
  /// Registration moved the landmarks of the frame for `target_ns` by so much.
  void registered(std::int64_t target_ns, const LandmarkPoints& moved_px);
  /// Compares what can be compared by now.
  void look_back(const HandTrack& track);

  const Motion& motion() const { return motion_; }

 private:
  void compare(const Frame& frame, const LandmarkPoints& at_camera,
               const LandmarkPoints& at_target);

  std::deque<Frame> waiting_;  ///< by target time
  std::int64_t compared_ns_ = 0;
  struct Trust {
    float measured_px = 0.5f, reckoned_px = 0.5f;
  };
  Trust trust_;  ///< what registration left, measured and as it was reckoned, means of the last
                 ///< second of it
  Motion motion_;
};

}  // namespace handcast::renderer
