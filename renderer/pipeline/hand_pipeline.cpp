// SPDX-License-Identifier: Apache-2.0
#include "renderer/pipeline/hand_pipeline.hpp"

#include <algorithm>
#include <utility>

#include "config/content_chain.hpp"
#include "ipc/base/log.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/content/textures.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/predict/plausible_pose.hpp"

namespace handcast::renderer {
namespace {

/// The settings of the filter. With late registration, jumps are smoothed after it and not in the
/// filter.
config::Filter filter_of(const config::Cascade& settings) {
  config::Filter filter = settings.filter;
  if (registration_of(settings).method != config::RegisterMethod::none) filter.blend_ms = 0;
  return filter;
}

/// What is painted until the content service says more: the content itself if it is one picture, or
/// white.
std::string still_of(const std::string& content) {
  const auto chain = config::parse_content(content);
  return chain && config::is_still(*chain) ? content : "builtin:white";
}

}  // namespace

config::Registration registration_of(const config::Cascade& settings) {
  config::Registration registration = settings.registration;
  if (settings.ladder.rung != config::RungChoice::registered ||
      !moves_with_tracker(settings.filter))
    registration.method = config::RegisterMethod::none;
  return registration;
}

HandPipeline::HandPipeline(Side side, const config::Cascade& settings,
                           const calib::Calibration& calibration, HandSurface surface,
                           MipChain picture, LandmarkOracle oracle)
    : side_(side),
      settings_(settings),
      calibration_(calibration),
      states_{.motion = {.track = HandTrack(settings.predict, calibration),
                         .landmarks = LandmarkTrack(filter_of(settings), std::move(oracle)),
                         .estimate = HandEstimate(calibration)},
              .light = {},
              .shape = HandStates::Shape(std::move(surface))},
      picture_(std::move(picture)) {}

Result<HandPipeline> HandPipeline::load(Side side, const config::Cascade& settings,
                                        const config::Content& content, const config::Hand& hand,
                                        const calib::Calibration& calibration,
                                        LandmarkOracle oracle) {
  const bool is_left = side == Side::left;
  const auto& model = is_left ? hand.left : hand.right;
  auto mesh = load_hand_or_default(model, side);
  if (!mesh) return tl::make_unexpected(mesh.error());
  const auto what = still_of(is_left ? content.left : content.right);
  auto texture = load_content(what, *mesh);
  if (!texture) return tl::make_unexpected(texture.error());
  // Models of other people have layouts, and so proportions, of their own.
  if (const auto note = note_on_proportions(what, *texture); model.empty() && !note.empty())
    log::warning("{}", note);
  if (mesh->vertex_count() > msg::kMaxVertices)
    log::warning("the hand has {} vertices: observers receive the first {} only",
                 mesh->vertex_count(), msg::kMaxVertices);
  HandSurface surface(std::move(*mesh), settings.mask.forearm_mm);
  return HandPipeline(side, settings, calibration, std::move(surface),
                      MipChain(*texture, content.smooth), std::move(oracle));
}

void HandPipeline::adjust(const config::Cascade& settings) {
  const bool is_other_filter = filter_of(settings) != filter_of(settings_);
  settings_ = settings;
  auto& motion = states_.motion;
  motion.track.adjust(settings.predict);
  if (is_other_filter) motion.landmarks.adjust(filter_of(settings));
}

void HandPipeline::aim(const calib::ProjectorModel& projector) {
  const auto handedness = [](const calib::ProjectorModel& model) {
    return glm::determinant(model.from_camera) > 0;
  };
  const bool is_mirrored = handedness(projector) != handedness(calibration_.projector);
  calibration_.projector = projector;
  if (!is_mirrored) return;
  // What was measured across the fingers has the other sign now.
  auto& shape = states_.shape;
  shape.fingers = FingerOutline(shape.surface.mesh());
  shape.palm = PalmOutline(shape.surface.mesh());
}

void HandPipeline::push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose) {
  if (!is_plausible(pose, calibration_.camera_from_tracker)) return;
  auto& motion = states_.motion;
  const auto pushed = motion.track.push(now_ns, origin_ns, pose);
  motion.landmarks.tracker_sample(now_ns, pushed);
  if (pushed == PoseHistory::Pushed::begins_anew) motion.estimate.tracker_jumped();
  if (estimates()) motion.estimate.look_back(motion.track);
  states_.shape.surface.learn(origin_ns, pose);
}

void HandPipeline::push(std::int64_t now_ns, std::int64_t origin_ns,
                        const msg::HandLandmarks& seen) {
  auto& motion = states_.motion;
  if (estimates()) {
    motion.estimate.detection(origin_ns, seen);
    motion.estimate.look_back(motion.track);
  }
  has_sigmas_ =
      std::ranges::any_of(seen.points, [](const auto& point) { return point.sigma_px > 0; });
  motion.landmarks.detection(now_ns, origin_ns, seen, motion.track);
}

std::optional<HandFrame> HandPipeline::predict(std::int64_t now_ns, std::int64_t target_ns) {
  auto& [motion, light, shape] = states_;
  motion.track.rest(estimates() ? motion.estimate.rest() : HandTrack::Rest{}, target_ns);
  const auto predicted = motion.track.predict(now_ns, target_ns);
  if (!predicted) {
    light.presence.no_hand(target_ns);
    light.sight.no_hand(target_ns);
    return std::nullopt;
  }
  const Filtered filtered = motion.landmarks.filter(now_ns, target_ns, *predicted);
  HandFrame frame;
  frame.presence = light.presence.at(target_ns, motion.track.newest_ns(), filtered.seen_ns);
  if (frame.presence == 0) {
    light.sight.no_hand(target_ns);
    return std::nullopt;
  }
  frame.corrected = corrected(target_ns, *predicted, filtered);
  motion.offset_px = frame.corrected.offset_px();
  frame.registered.landmarks = frame.corrected.landmarks;
  return frame;
}

/// The hand without the tracker's errors. Empty if they are not known, the landmarks contradict the
/// tracker, or it is silent.
std::optional<ProjectedPose> HandPipeline::estimated(std::int64_t target_ns,
                                                     const Predicted& predicted) const {
  const auto& estimate = states_.motion.estimate;
  if (!estimates() || predicted.is_silent || !estimate.knows()) return std::nullopt;
  const auto time_ns = states_.motion.track.held_ns(target_ns);
  return project(calibration_, estimate.corrected(time_ns, predicted.posed.pose));
}

/// The hand on its rung.
Corrected HandPipeline::corrected(std::int64_t target_ns, const Predicted& predicted,
                                  const Filtered& filtered) const {
  Corrected hand{.posed = predicted.posed,
                 .estimated = estimated(target_ns, predicted),
                 .landmarks = filtered.landmarks,
                 .has_landmarks = filtered.has_landmarks,
                 .has_news = filtered.has_news,
                 .rung = rung_of(settings_.ladder.rung)};
  if (hand.estimated) {
    hand.landmarks = hand.estimated->landmarks;
    hand.has_landmarks = true;
  } else {
    hand.is_alone = settings_.filter.method != config::FilterMethod::paper;
    if (hand.is_alone) hand.rung = std::min(hand.rung, Rung::landmarks);
    if (!hand.has_landmarks) hand.rung = std::min(hand.rung, Rung::predict);
  }
  if (hand.rung >= Rung::landmarks) return hand;
  hand.estimated.reset();
  hand.has_landmarks = hand.has_landmarks && hand.rung >= Rung::shift;
  const auto& track = states_.motion.track;
  if (hand.rung == Rung::hold)
    if (const auto newest = track.projected_at(track.newest_ns())) hand.posed = *newest;
  hand.landmarks = on_rung(hand.rung, hand.posed.landmarks, hand.landmarks);
  return hand;
}

HandMask::Sought HandPipeline::sought(const HandFrame& frame, std::int64_t image_ns) const {
  return {side_, states_.motion.track.projected_at(image_ns), frame.corrected.offset_px(),
          frame.corrected.has_landmarks};
}

HandMask::Moved HandPipeline::moved(const HandFrame& frame) const {
  return {frame.presence,
          frame.corrected.posed.landmarks,
          frame.corrected.landmarks,
          frame.registered.moved_then,
          frame.registered.moved_now,
          frame.skinned->projected_px,
          frame.skinned->depth_m};
}

void HandPipeline::dim(HandFrame& frame, std::int64_t target_ns) {
  frame.presence =
      std::min(frame.presence, states_.light.sight.at(target_ns, states_.light.is_shown));
}

std::optional<LateRegistration::Hand> HandPipeline::to_register(const HandFrame& frame) const {
  return frame.corrected.has_landmarks ? std::optional(late_hand(frame)) : std::nullopt;
}

LateRegistration::Hand HandPipeline::late_hand(const HandFrame& frame) const {
  const Corrected& corrected = frame.corrected;
  return {side_, &states_.motion.track, corrected.posed.landmarks, corrected.offset_px(),
          corrected.is_alone};
}

void HandPipeline::register_motion(HandFrame& frame, LateRegistration& late,
                                   std::int64_t target_ns) {
  const Corrected& corrected = frame.corrected;
  if (!corrected.has_landmarks) return;
  if (corrected.is_alone) {
    frame.registered.landmarks = late.follow(late_hand(frame), target_ns, corrected.has_news);
    return;
  }
  frame.registered = late.correct(late_hand(frame), target_ns);
}

void HandPipeline::skin(HandFrame& frame, float shading, bool is_shared) {
  auto& shape = states_.shape;
  frame.drawn = frame.corrected.estimated.value_or(frame.corrected.posed);
  frame.from_px = to_projector(frame.drawn.landmarks, frame.drawn);
  frame.to_px = to_projector(frame.registered.landmarks, frame.drawn);
  if (settings_.correct.outline) frame.to_px = shape.fingers.moved(frame.to_px);
  frame.skinned = shape.surface.pose(frame.drawn.pose, settings_.skin, calibration_, shading,
                                     frame.presence, is_shared);
}

LandmarkPoints HandPipeline::to_projector(const LandmarkPoints& camera_px,
                                          const ProjectedPose& depths) const {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i)
    points[i] =
        calibration_.projector.pixel_of(camera_px[i], static_cast<float>(depths.depths_m[i]));
  return points;
}

int HandPipeline::correct(HandFrame& frame) {
  if (!frame.corrected.has_landmarks) return 0;
  auto& shape = states_.shape;
  const Skinned& skinned = *frame.skinned;
  correct_vertices(settings_.correct, shape.surface.mesh(), frame.from_px, frame.to_px,
                   skinned.projected_px);
  if (settings_.correct.outline) shape.palm.move(frame.to_px, skinned.projected_px);
  return shape.foldover_repair.repair(skinned.seen_px, skinned.projected_px, skinned.facing_sign);
}

int HandPipeline::foldovers(const HandFrame& frame) const {
  const Skinned& skinned = *frame.skinned;
  return states_.shape.foldover_repair.count(skinned.seen_px, skinned.projected_px,
                                             skinned.facing_sign);
}

void HandPipeline::learn_outline(const HandFrame& frame, std::int64_t target_ns, GreyView mask) {
  if (!frame.corrected.has_landmarks) return;
  auto& shape = states_.shape;
  if (settings_.skin.fit && settings_.skin.widths)
    shape.surface.learn_widths(target_ns, frame.to_px, mask);
  // Landmarks without sigmas may be exact: the twin's model has none, and pulling them to the
  // outline of a drawn shape that is not exact makes them worse.
  if (settings_.correct.method != config::CorrectMethod::vertices || !settings_.correct.outline ||
      !has_sigmas_)
    return;
  shape.palm.measure(target_ns, frame.skinned->projected_px, frame.to_px, mask);
  shape.fingers.measure(target_ns, frame.skinned->projected_px, frame.to_px, mask);
}

LightShare::Hand HandPipeline::shared(const HandFrame& frame) const {
  const Skinned& skinned = *frame.skinned;
  return {skinned.position_m, skinned.normal, skinned.light};
}

DrawnHand HandPipeline::drawn(const Skinned& skinned,
                              std::span<const glm::vec2> position_px) const {
  return {&states_.shape.surface.mesh(),
          worn_.texels != nullptr ? worn_ : picture_.view(),
          position_px,
          skinned.distance_m,
          skinned.light,
          mesh_revision_,
          picture_revision_};
}

FrameHand HandPipeline::described(const HandFrame& frame) const {
  const Corrected& corrected = frame.corrected;
  FrameHand hand;
  hand.side = side_;
  hand.tracker = corrected.posed.landmarks;
  hand.corrected = frame.registered.landmarks;
  hand.presence = frame.presence;
  hand.has_landmarks = corrected.has_landmarks;
  hand.rung = corrected.rung;
  if (frame.skinned) hand.projected_px = frame.skinned->projected_px;
  return hand;
}

}  // namespace handcast::renderer
