#pragma once
#include <cstdint>
#include <optional>

#include "renderer/cascade/rung.hpp"
#include "renderer/pipeline.hpp"
#include "renderer/pipeline/hand_ladder.hpp"
#include "renderer/pipeline/hand_mask.hpp"
#include "renderer/pipeline/hand_surface.hpp"
#include "renderer/pipeline/hand_track.hpp"
#include "renderer/pipeline/late_registration.hpp"

namespace handcast::renderer {

/// What late registration does in a rig: nothing where a lower rung is set, or where the landmarks do not move with the tracker, whose
/// prediction it corrects.
config::Registration registration_of(const config::Cascade& settings);

/// One hand on its way from its sensors' samples to its light. The pipeline takes all hands through a step before the next one, for they
/// share the camera's image. After a predict() that is true, a frame's steps come in this order; each may be left out.
class HandLight {
 public:
  HandLight(Side side, const config::Cascade& settings, const calib::Calibration& calibration, HandSurface surface, LandmarkOracle oracle);

  Side side() const { return side_; }
  const HandTrack& track() const { return track_; }

  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose);
  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen);

  /// Where the hand and its landmarks will be at `target_ns`. `camera_ns`: when the image was taken that the frame can be registered to.
  /// False: the hand is not in sight.
  bool predict(std::int64_t now_ns, std::int64_t target_ns, std::optional<std::int64_t> camera_ns);

  /// As the mask is to look for it in an image exposed around `camera_ns`, and to move it on.
  HandMask::Expected expected(std::int64_t camera_ns) const;
  /// The newest image shows the hand, or does not (any more).
  void seen(bool in_sight) { in_sight_ = in_sight; }
  /// Takes the light from a hand that the image does not show, little by little.
  void dim(std::int64_t target_ns);

  /// Nothing where the hand is on a rung that does without registration.
  std::optional<LateRegistration::Hand> to_register() const;
  /// Moves the landmarks by what the newest images know of the motion and the tracker does not.
  void correct_motion(LateRegistration& late, std::int64_t target_ns);

  /// Skins the mesh and sees it from the projector.
  void skin(float shading);
  /// The landmarks as the tracker has them, and where they are: projector px.
  LandmarkPoints from_px() const { return to_projector(tracked_.tracker); }
  LandmarkPoints to_px() const { return to_projector(corrected_); }
  bool has_landmarks() const { return tracked_.has_landmarks; }
  /// Moves the landings to where the landmarks are, as its rung does. Returns how many triangles stay turned over.
  int correct();
  /// The mask of this hand in the projector's pixels, to know the person by.
  void learn_widths(std::int64_t target_ns, GreyView mask);

  bool is_lit() const { return tracked_.presence > 0; }
  Rung rung() const { return step_.rung; }
  HandSurface& surface() { return surface_; }
  const HandSurface& surface() const { return surface_; }
  FrameHand frame() const;

 private:
  LandmarkPoints to_projector(const LandmarkPoints& camera_px) const;
  LateRegistration::Hand late_hand() const;

  Side side_;
  config::Cascade settings_;
  calib::Calibration calibration_;
  HandTrack track_;
  HandLadder ladder_;
  HandSurface surface_;
  RungMover mover_;
  Sight sight_;
  bool in_sight_ = false;

  // One frame's.
  HandTrack::Tracked tracked_;
  HandLadder::Step step_;
  LandmarkPoints corrected_{};             ///< Q̂ with late registration
  LandmarkPoints moved_then_, moved_now_;  ///< by late registration, at the exposure and at the target time
  bool is_skinned_ = false;
};

}  // namespace handcast::renderer
