// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "renderer/base/recent.hpp"
#include "renderer/predict/hand_track.hpp"

namespace handcast::renderer {

/// The error of the light caused by motion of the hand, measured in hindsight: once the tracker has
/// samples up to the target time of a frame, the prediction of the frame is compared with them. One
/// thread.
class Hindsight {
 public:
  /// Errors caused by motion: RMS over the landmarks, camera px, averaged over about 100 ms while
  /// it grows and about 300 ms while it falls, because gestures come in bursts. The RMS is
  /// averaged, not its square: a mean square is dominated by the few moments in which every rung is
  /// far off, and hides how the rungs differ in the others.
  struct Motion {
    float hold_px = 0;     ///< of the newest sample, held
    float predict_px = 0;  ///< of the prediction for the target time
    /// Of that prediction after registration to the newest image. Measured in frames that were
    /// registered; otherwise estimated from how the prediction for the time of the image was
    /// shifted, rotated and scaled, which the image would have shown.
    float register_px = 0;
  };

  /// A frame, and P as it was known when the frame was drawn.
  struct Frame {
    std::int64_t target_ns = 0;  ///< the time of its photons
    std::int64_t camera_ns = 0;  ///< the exposure of its image
    std::int64_t newest_ns = 0;  ///< the newest tracker sample
    LandmarkPoints newest{};     ///< P of the newest sample
    LandmarkPoints at_camera{};  ///< P at camera_ns
    LandmarkPoints at_target{};  ///< P at target_ns
    /// Displacement of at_target by registration; empty if the frame was not registered.
    std::optional<LandmarkPoints> registered;
  };

  /// True if the frame for `target_ns` should be given to remember(): not all are needed.
  bool wants(std::int64_t target_ns) const;
  /// Keeps a frame for look_back(). Frames must come in the order of their target times.
  void remember(const Frame& frame);
  /// Registration moved the landmarks of the frame for `target_ns` by `moved_px`. Ignored if that
  /// is not the last remembered frame.
  void registered(std::int64_t target_ns, const LandmarkPoints& moved_px);
  /// Compares the frames whose target times the samples of `track` have reached.
  void look_back(const HandTrack& track);

  /// The errors measured so far.
  const Motion& motion() const { return motion_; }

 private:
  void compare(const Frame& frame, const LandmarkPoints& at_camera,
               const LandmarkPoints& at_target);

  static constexpr std::size_t kMostWaiting = 32;

  Recent<Frame> waiting_{kMostWaiting};  ///< by target time
  std::int64_t compared_ns_ = 0;
  /// Errors of registered frames, measured and estimated: means over about a second.
  struct RegistrationErrors {
    float measured_px = 0.5f, estimated_px = 0.5f;
  };
  RegistrationErrors registration_errors_;
  Motion motion_;
};

}  // namespace handcast::renderer
