// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <utility>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "config/sections/content.hpp"
#include "config/sections/projector.hpp"
#include "renderer/blend/light_share.hpp"
#include "renderer/correct/finger_outline.hpp"
#include "renderer/correct/foldover_repair.hpp"
#include "renderer/correct/palm_outline.hpp"
#include "renderer/correct/rung.hpp"
#include "renderer/draw/painter.hpp"
#include "renderer/estimate/hand_estimate.hpp"
#include "renderer/filter/landmark_track.hpp"
#include "renderer/mask/hand_mask.hpp"
#include "renderer/pipeline/frame.hpp"
#include "renderer/predict/hand_track.hpp"
#include "renderer/predict/presence.hpp"
#include "renderer/register/late_registration.hpp"
#include "renderer/skin/hand_surface.hpp"

namespace handcast::renderer {

/// The settings of late registration that take effect. The method is none if a lower rung is set,
/// or if Q̂ does not move with P, whose prediction late registration corrects.
config::Registration registration_of(const config::Cascade& settings);

/// One hand at the time of the photons: it is drawn in a pose and moved onto Q̂.
struct Corrected {
  ProjectedPose posed;                     ///< of the tracker, with P
  std::optional<ProjectedPose> estimated;  ///< the hand without the tracker's errors
  LandmarkPoints landmarks{};              ///< Q̂, or P if nothing corrects it
  bool has_landmarks = false;  ///< `landmarks` are Q̂, even if the rung leaves them at P
  bool is_alone = false;       ///< Q̂ was computed without the tracker
  bool has_news = true;        ///< see Filtered::has_news
  Rung rung = Rung::registered;

  /// Q̂ - P.
  LandmarkPoints offset_px() const { return difference(landmarks, posed.landmarks); }
};

/// One hand in one frame: the value that each step made.
struct HandFrame {
  Corrected corrected;        ///< predict, filter and estimate
  float presence = 1;         ///< share of its light, 0..1
  RegisteredHand registered;  ///< register
  ProjectedPose drawn;        ///< skin: the pose that was skinned
  /// Skin: the landmarks before and after the correction, P of `drawn` and Q̂, projector px.
  /// @{
  LandmarkPoints from_px{}, to_px{};
  /// @}
  std::optional<Skinned> skinned;  ///< skin; its projected vertices are moved by correct
};

/// What is known of one hand from one message or frame to the next.
struct HandStates {
  /// Where the hand is: the states of predict, filter and estimate.
  struct Motion {
    HandTrack track;
    LandmarkTrack landmarks;
    HandEstimate estimate;
    LandmarkPoints offset_px{};  ///< Q̂ - P of the last frame
  } motion;
  /// How much light it gets.
  struct Light {
    Presence presence;      ///< by the age of the sensors' data
    Sight sight;            ///< by what the camera shows
    bool is_shown = false;  ///< by the newest image
  } light;
  /// The person's hand: the states of skin and correct.
  struct Shape {
    explicit Shape(HandSurface hand)
        : surface(std::move(hand)),
          fingers(surface.mesh()),
          palm(surface.mesh()),
          foldover_repair(surface.mesh()) {}

    HandSurface surface;
    FingerOutline fingers;
    PalmOutline palm;
    FoldoverRepair foldover_repair;
  } shape;
};

/// The steps for one hand. The pipeline does a step for all hands before the next step, because the
/// hands share the camera's image (Pipeline::place()). One thread.
class HandPipeline {
 public:
  /// Loads the mesh and the content of one hand of the settings. `oracle`: see
  /// make_landmark_filter(). Errors (bad_config): those of load_hand_or_default() and
  /// load_content().
  static Result<HandPipeline> load(Side side, const config::Cascade& settings,
                                   const config::Content& content, const config::Hand& hand,
                                   const calib::Calibration& calibration, LandmarkOracle oracle);

  /// See Pipeline::adjust() and Pipeline::aim().
  /// @{
  void adjust(const config::Cascade& settings);
  void aim(const calib::ProjectorModel& projector);
  /// @}

  /// Which hand it is.
  Side side() const { return side_; }

  /// Adds a tracker sample or a detection of this hand, with origin `origin_ns`, that arrived at
  /// `now_ns`. A pose that is not plausible (is_plausible()) is dropped.
  /// @{
  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose);
  void push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen);
  /// @}
  /// Where the sensors are expected to find the hand at `time_ns`: the pose in tracker space, and
  /// the landmarks. Empty if the newest tracker sample is more than 0.2 s older.
  /// @{
  std::optional<msg::HandPose> expected_pose(std::int64_t time_ns) const {
    return states_.motion.track.recent_pose(time_ns);
  }
  std::optional<LandmarkPoints> expected_landmarks(std::int64_t time_ns) const {
    const auto points = states_.motion.track.recent_landmarks(time_ns);
    return points ? std::optional(sum(*points, states_.motion.offset_px)) : std::nullopt;
  }
  /// @}

  /// Steps predict, filter and estimate: the hand and its landmarks at `target_ns`. Empty if there
  /// is no hand, or its light has faded out (Presence).
  std::optional<HandFrame> predict(std::int64_t now_ns, std::int64_t target_ns);

  /// The hand to be found in an image exposed at `image_ns`.
  HandMask::Sought sought(const HandFrame& frame, std::int64_t image_ns) const;
  /// The hand to which its mask is moved.
  HandMask::Moved moved(const HandFrame& frame) const;
  /// Sets whether the newest image shows the hand (HandMask::shows()).
  void set_shown(bool is_shown) { states_.light.is_shown = is_shown; }
  /// Fades the light of a hand that the newest image does not show (Sight).
  void dim(HandFrame& frame, std::int64_t target_ns);

  /// The hand to be registered. Empty if its rung does without registration.
  std::optional<LateRegistration::Hand> to_register(const HandFrame& frame) const;
  /// Step register: corrects the landmarks by the motion that the newest image shows.
  void register_motion(HandFrame& frame, LateRegistration& late, std::int64_t target_ns);

  /// Step skin: poses the mesh. `shading` and `is_shared`: see HandSurface::pose().
  void skin(HandFrame& frame, float shading, bool is_shared = false);
  /// The posed hand, whose light is to be shared.
  LightShare::Hand shared(const HandFrame& frame) const;
  /// Step correct: moves the projected vertices from P onto Q̂ by the model of the frame's rung.
  /// Returns the number of triangles that remain turned over.
  int correct(HandFrame& frame);
  /// The number of triangles that a warp of the projected vertices has turned over.
  int foldovers(const HandFrame& frame) const;
  /// Learns the widths of the person's fingers, where they are beside their landmarks, and the
  /// borders of the palm. `mask`: of this hand, projector px.
  void learn_outline(const HandFrame& frame, std::int64_t target_ns, GreyView mask);

  /// Sets the picture of the hand: see Pipeline::wear().
  void wear(const MipView& picture) {
    worn_ = picture;
    picture_revision_ = new_revision();
  }
  /// The hand for the painter, with its vertices at `position_px`. Borrows the mesh and the
  /// picture.
  DrawnHand drawn(const Skinned& skinned, std::span<const glm::vec2> position_px) const;
  /// Bounds of the drawn vertices if they are at `position_px`.
  Rect bounds(std::span<const glm::vec2> position_px) const {
    return states_.shape.surface.bounds(position_px);
  }
  /// The hand for scores and traces.
  FrameHand described(const HandFrame& frame) const;

 private:
  HandPipeline(Side side, const config::Cascade& settings, const calib::Calibration& calibration,
               HandSurface surface, MipChain picture, LandmarkOracle oracle);

  /// True if the tracker's errors are estimated.
  bool estimates() const { return settings_.filter.method == config::FilterMethod::articulated; }
  std::optional<ProjectedPose> estimated(std::int64_t target_ns, const Predicted& predicted) const;
  Corrected corrected(std::int64_t target_ns, const Predicted& predicted,
                      const Filtered& filtered) const;
  LandmarkPoints to_projector(const LandmarkPoints& camera_px, const ProjectedPose& depths) const;
  LateRegistration::Hand late_hand(const HandFrame& frame) const;

  Side side_;
  config::Cascade settings_;
  calib::Calibration calibration_;
  HandStates states_;
  bool has_sigmas_ = false;  ///< the detector says how wrong its landmarks may be
  MipChain picture_;
  MipView worn_;  ///< the picture of now; without texels, picture_
  std::uint64_t mesh_revision_ = new_revision(), picture_revision_ = new_revision();
};

}  // namespace handcast::renderer
