// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/correct/rung_mover.hpp"
#include "renderer/correct/untangle.hpp"
#include "renderer/draw/painter.hpp"
#include "renderer/filter/landmark_track.hpp"
#include "renderer/ladder/hand_ladder.hpp"
#include "renderer/mask/hand_mask.hpp"
#include "renderer/pipeline/frame.hpp"
#include "renderer/predict/hand_track.hpp"
#include "renderer/predict/presence.hpp"
#include "renderer/register/late_registration.hpp"
#include "renderer/skin/hand_surface.hpp"

namespace handcast::renderer {

/// What late registration does in a rig: nothing if a lower rung is set, or if the landmarks do not
/// move with the tracker, whose prediction it corrects.
config::Registration registration_of(const config::Cascade& settings);

/// What the steps of one frame have made of one hand.
struct HandFrame {
  Corrected corrected;             ///< by predict, filter and the ladder
  RegisteredHand registered;       ///< by register
  float presence = 1;              ///< share of its light, 0..1
  std::optional<Skinned> skinned;  ///< by skin; its landings are moved by correct
};

/// The states of the steps for one hand, and the steps on them. The pipeline takes all hands
/// through a step before the next one, for they share the camera's image. After a predict() that
/// yields a frame, its steps come in this order; each may be left out.
class HandPipeline {
 public:
  /// Errors: bad_config (no such hand file, no such content).
  static Result<HandPipeline> load(Side side, const config::Cascade& settings,
                                   const std::string& content, const std::string& hand_file,
                                   const calib::Calibration& calibration, LandmarkOracle oracle);

  Side side() const { return side_; }

  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose);
  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen);
  /// Where the sensors' next samples should find the hand. Empty if it is not in sight.
  std::optional<msg::HandPose> expected_pose(std::int64_t time_ns) const {
    return track_.recent_pose(time_ns);
  }
  std::optional<LandmarkPoints> expected_landmarks(std::int64_t time_ns) const {
    return landmarks_.expected_at(time_ns, track_);
  }

  /// Steps predict, filter and ladder: the hand and its landmarks at `target_ns`. `image_ns`: when
  /// the image was exposed that the frame can be registered to. Empty if the hand is not in sight.
  std::optional<HandFrame> predict(std::int64_t now_ns, std::int64_t target_ns,
                                   std::optional<std::int64_t> image_ns);

  /// Where the mask is to look for it in an image exposed at `image_ns`.
  HandMask::Expected expected(const HandFrame& frame, std::int64_t image_ns) const;
  /// The newest image shows the hand, or does not (any more).
  void set_shown(bool is_shown) { is_shown_ = is_shown; }
  /// Takes the light from a hand that the newest image does not show, little by little.
  void dim(HandFrame& frame, std::int64_t target_ns);

  /// Empty if the hand is on a rung that does without registration.
  std::optional<LateRegistration::Hand> to_register(const HandFrame& frame) const;
  /// Step register: moves the landmarks by what the newest images know of the motion and the
  /// tracker does not.
  void register_motion(HandFrame& frame, LateRegistration& late, std::int64_t target_ns);

  /// Step skin.
  void skin(HandFrame& frame, float shading);
  /// P and Q̂ in projector px.
  LandmarkPoints from_px(const HandFrame& frame) const {
    return to_projector(frame.corrected.tracker);
  }
  LandmarkPoints to_px(const HandFrame& frame) const {
    return to_projector(frame.registered.landmarks);
  }
  /// Step correct: moves the landings as the frame's rung does. Returns how many triangles stay
  /// turned over.
  int correct(HandFrame& frame);
  /// Learns the person's widths from the mask of this hand in projector px.
  void learn_widths(const HandFrame& frame, std::int64_t target_ns, GreyView mask);

  /// What the painter is to draw, with its vertices at `position_px`.
  DrawnHand drawn(const Skinned& skinned, std::span<const glm::vec2> position_px) const;
  Rect bounds(std::span<const glm::vec2> position_px) const { return surface_.bounds(position_px); }
  FrameHand described(const HandFrame& frame) const;

 private:
  HandPipeline(Side side, const config::Cascade& settings, const calib::Calibration& calibration,
               HandSurface surface, Texture texture, LandmarkOracle oracle);

  LandmarkPoints to_projector(const LandmarkPoints& camera_px) const;
  LateRegistration::Hand late_hand(const HandFrame& frame) const;

  Side side_;
  config::Cascade settings_;
  calib::Calibration calibration_;

  HandTrack track_;
  LandmarkTrack landmarks_;
  Presence presence_;
  HandLadder ladder_;
  Sight sight_;
  bool is_shown_ = false;
  HandSurface surface_;
  RungMover mover_;
  Untangler untangler_;
  Texture texture_;
};

}  // namespace handcast::renderer
