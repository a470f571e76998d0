// SPDX-License-Identifier: Apache-2.0
#include "renderer/pipeline/hand_pipeline.hpp"

#include <algorithm>
#include <utility>

#include "ipc/base/log.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/content/textures.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/predict/project_landmarks.hpp"
#include "renderer/skin/finger_bend.hpp"

namespace handcast::renderer {
namespace {

/// The settings of the filter. With late registration, jumps are smoothed after it and not in the
/// filter.
config::Filter filter_of(const config::Cascade& settings) {
  config::Filter filter = settings.filter;
  if (registration_of(settings).method != config::RegisterMethod::none) filter.blend_ms = 0;
  return filter;
}

}  // namespace

config::Registration registration_of(const config::Cascade& settings) {
  config::Registration registration = settings.registration;
  const bool may_register = settings.ladder.rung == config::RungChoice::automatic ||
                            settings.ladder.rung == config::RungChoice::registered;
  if (!may_register || !moves_with_tracker(settings.filter))
    registration.method = config::RegisterMethod::none;
  return registration;
}

HandPipeline::HandPipeline(Side side, const config::Cascade& settings,
                           const calib::Calibration& calibration, HandSurface surface,
                           MipChain picture, LandmarkOracle oracle)
    : side_(side),
      settings_(settings),
      calibration_(calibration),
      snaps_(calibration),
      track_(settings.predict, calibration),
      landmarks_(filter_of(settings), std::move(oracle)),
      ladder_(settings),
      surface_(std::move(surface)),
      turn_(calibration),
      definitions_(calibration),
      fingers_(surface_.mesh()),
      palm_(surface_.mesh()),
      mover_(surface_.mesh()),
      untangler_(surface_.mesh()),
      picture_(std::move(picture)) {}

Result<HandPipeline> HandPipeline::load(Side side, const config::Cascade& settings,
                                        const config::Content& content, const config::Hand& hand,
                                        const calib::Calibration& calibration,
                                        LandmarkOracle oracle) {
  const bool is_left = side == Side::left;
  auto mesh = load_hand_or_default(is_left ? hand.left : hand.right, side);
  if (!mesh) return tl::make_unexpected(mesh.error());
  auto texture = load_content(is_left ? content.left : content.right, *mesh);
  if (!texture) return tl::make_unexpected(texture.error());
  if (mesh->vertex_count() > msg::kMaxVertices)
    log::warning("the hand has {} vertices: observers receive the landings of the first {} only",
                 mesh->vertex_count(), msg::kMaxVertices);
  HandSurface surface(std::move(*mesh), settings.mask.forearm_mm);
  return HandPipeline(side, settings, calibration, std::move(surface),
                      MipChain(*texture, content.smooth), std::move(oracle));
}

void HandPipeline::push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose) {
  if (landmarks_.is_alone()) snaps_.forget();
  const auto held = settings_.predict.method == config::PredictMethod::acceleration
                        ? snaps_.held(origin_ns, pose, landmarks_.moved_px())
                        : pose;
  landmarks_.tracker_sample(now_ns, track_.push(now_ns, origin_ns, held));
  surface_.learn(origin_ns, held);
}

void HandPipeline::push(std::int64_t now_ns, std::int64_t origin_ns,
                        const msg::HandLandmarks& seen) {
  const auto pose = track_.recent_pose(origin_ns);
  if (pose && !landmarks_.is_alone()) {
    if (settings_.skin.turn) turn_.learn(origin_ns, *pose, seen);
    if (settings_.filter.definitions) definitions_.learn(origin_ns, turn_.turned(*pose), seen);
  }
  has_sigmas_ =
      std::ranges::any_of(seen.points, [](const auto& point) { return point.sigma_px > 0; });
  const auto as_tracked = definitions_.as_tracked(seen);
  snaps_.detection(origin_ns, as_tracked);
  if (!landmarks_.is_alone()) ladder_.detection(track_, origin_ns, as_tracked);
  landmarks_.detection(now_ns, origin_ns, as_tracked, track_);
}

std::optional<HandFrame> HandPipeline::predict(std::int64_t now_ns, std::int64_t target_ns,
                                               std::optional<std::int64_t> image_ns) {
  const auto predicted = track_.predict(now_ns, target_ns);
  if (!predicted) {
    presence_.no_hand(target_ns);
    sight_.no_hand(target_ns);
    return std::nullopt;
  }
  const Filtered filtered = landmarks_.filter(now_ns, target_ns, *predicted);
  HandFrame frame;
  frame.presence = presence_.at(target_ns, track_.newest_ns(), filtered.seen_ns);
  if (frame.presence == 0) {
    sight_.no_hand(target_ns);
    return std::nullopt;
  }
  frame.corrected = ladder_.take(track_, target_ns, image_ns, *predicted, filtered);
  frame.registered.landmarks = frame.corrected.landmarks;
  return frame;
}

HandMask::Expected HandPipeline::expected(const HandFrame& frame, std::int64_t image_ns) const {
  HandMask::Expected hand{side_,          track_.pose_at(image_ns),    &frame.corrected,
                          frame.presence, frame.registered.moved_then, frame.registered.moved_now};
  if (frame.skinned) {
    hand.landings_px = frame.skinned->landings_px;
    hand.depths_m = frame.skinned->depth_m;
  }
  return hand;
}

void HandPipeline::dim(HandFrame& frame, std::int64_t target_ns) {
  frame.presence = std::min(frame.presence, sight_.at(target_ns, is_shown_));
}

std::optional<LateRegistration::Hand> HandPipeline::to_register(const HandFrame& frame) const {
  const bool is_needed = frame.corrected.has_landmarks && frame.corrected.registered > 0;
  return is_needed ? std::optional(late_hand(frame)) : std::nullopt;
}

LateRegistration::Hand HandPipeline::late_hand(const HandFrame& frame) const {
  const Corrected& corrected = frame.corrected;
  return {side_, &track_, corrected.tracker, corrected.offset_px(), corrected.is_alone};
}

void HandPipeline::register_motion(HandFrame& frame, LateRegistration& late,
                                   std::int64_t target_ns) {
  const Corrected& corrected = frame.corrected;
  if (!corrected.has_landmarks) return;
  if (corrected.is_alone) {
    frame.registered.landmarks = late.follow(late_hand(frame), target_ns, corrected.has_news);
    return;
  }
  frame.registered = late.correct(late_hand(frame), target_ns, corrected.registered);
  if (corrected.registered == 1) ladder_.registered(target_ns, frame.registered.moved_now);
}

void HandPipeline::skin(HandFrame& frame, float shading) {
  frame.drawn_from = frame.corrected.tracker;
  msg::HandPose pose = frame.corrected.pose;
  const auto draw_from = [&](const msg::HandPose& changed) {
    if (const auto joints_px = project_landmarks(calibration_, changed)) {
      frame.drawn_from = *joints_px;
      pose = changed;
    }
  };
  if (settings_.skin.turn) draw_from(turn_.turned(pose));
  if (settings_.skin.bend && frame.corrected.has_landmarks)
    draw_from(bent(pose, frame.registered.landmarks, calibration_));
  frame.depths_m = landmark_depths_m(calibration_, pose);
  frame.skinned = surface_.pose(pose, settings_.skin, calibration_, shading, frame.presence);
}

LandmarkPoints HandPipeline::to_projector(const LandmarkPoints& camera_px,
                                          const std::array<float, kLandmarks>& depths_m) const {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i)
    points[i] = calibration_.to_projector(camera_px[i], depths_m[i]);
  return points;
}

int HandPipeline::correct(HandFrame& frame) {
  const Corrected& corrected = frame.corrected;
  if (!corrected.has_landmarks) return 0;
  const Skinned& skinned = *frame.skinned;
  if (corrected.moves < Rung::landmarks) {
    mover_.move(fit_rung(corrected.moves, from_px(frame), to_px(frame)), skinned.landings_px);
  } else {
    correct_vertices(settings_.correct, surface_.mesh(), from_px(frame), to_px(frame),
                     skinned.landings_px);
  }
  if (settings_.correct.outline) palm_.move(to_px(frame), skinned.landings_px);
  if (corrected.moves < Rung::fingers) return 0;
  return untangler_.untangle(skinned.seen_px, skinned.landings_px, skinned.facing_sign);
}

int HandPipeline::foldovers(const HandFrame& frame) const {
  const Skinned& skinned = *frame.skinned;
  return untangler_.count(skinned.seen_px, skinned.landings_px, skinned.facing_sign);
}

void HandPipeline::learn_outline(const HandFrame& frame, std::int64_t target_ns, GreyView mask) {
  if (!frame.corrected.has_landmarks) return;
  const LandmarkPoints landmarks_px = to_px(frame);
  if (settings_.skin.fit && settings_.skin.widths)
    surface_.learn_widths(target_ns, landmarks_px, mask);
  // Landmarks without sigmas may be exact: the twin's model has none, and pulling them to the
  // outline of a drawn shape that is not exact makes them worse.
  if (settings_.correct.method != config::CorrectMethod::vertices || !settings_.correct.outline ||
      !has_sigmas_)
    return;
  palm_.measure(target_ns, frame.skinned->landings_px, landmarks_px, mask);
  fingers_.measure(target_ns, frame.skinned->landings_px, landmarks_px, mask);
}

DrawnHand HandPipeline::drawn(const Skinned& skinned,
                              std::span<const glm::vec2> position_px) const {
  return {&surface_.mesh(), &picture_, position_px, skinned.depth_m, skinned.light, revision_};
}

FrameHand HandPipeline::described(const HandFrame& frame) const {
  const Corrected& corrected = frame.corrected;
  FrameHand hand;
  hand.side = side_;
  hand.tracker = corrected.tracker;
  hand.corrected = frame.registered.landmarks;
  hand.presence = frame.presence;
  hand.has_landmarks = corrected.has_landmarks;
  hand.rung = corrected.rung;
  if (frame.skinned) hand.landings = frame.skinned->landings_px;
  return hand;
}

}  // namespace handcast::renderer
