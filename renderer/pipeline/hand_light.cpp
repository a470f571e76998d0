#include "renderer/pipeline/hand_light.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

/// With late registration jumps are blended in after it.
config::Cascade of_track(config::Cascade settings) {
  if (registration_of(settings).method != "none") settings.filter.blend_ms = 0;
  return settings;
}

}  // namespace

config::Registration registration_of(const config::Cascade& settings) {
  config::Registration registration = settings.registration;
  if (!moves_with_tracker(settings.filter)) registration.method = "none";
  if (settings.ladder.rung != "auto" && settings.ladder.rung != "register") registration.method = "none";
  return registration;
}

HandLight::HandLight(Side side, const config::Cascade& settings, const calib::Calibration& calibration, HandSurface surface,
                     LandmarkOracle oracle)
    : side_(side),
      settings_(settings),
      calibration_(calibration),
      track_(of_track(settings), calibration, std::move(oracle)),
      ladder_(settings, calibration),
      surface_(std::move(surface)),
      mover_(surface_.mesh()) {}

void HandLight::push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose) {
  track_.push(now_ns, origin_ns, pose);
  surface_.learn(origin_ns, pose);
}

void HandLight::push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen) {
  if (!track_.alone()) ladder_.detection(track_, origin_ns, seen);
  track_.push(now_ns, origin_ns, seen);
}

bool HandLight::predict(std::int64_t now_ns, std::int64_t target_ns, std::optional<std::int64_t> camera_ns) {
  const auto tracked = track_.at(now_ns, target_ns);
  if (!tracked) {
    sight_.gone(target_ns);
    return false;
  }
  tracked_ = *tracked;
  if (tracked_.alone) {
    ladder_ = HandLadder(settings_, calibration_);  // what it has learned was of another tracker
    step_ = {Rung::landmarks, Rung::landmarks, 0};
  } else {
    step_ = ladder_.take(track_, target_ns, camera_ns, tracked_);
  }
  corrected_ = tracked_.corrected;
  moved_then_.fill(glm::vec2(0));
  moved_now_.fill(glm::vec2(0));
  is_skinned_ = false;
  return true;
}

HandMask::Expected HandLight::expected(std::int64_t camera_ns) const {
  return {side_, track_.pose_at(camera_ns), &tracked_, moved_then_, moved_now_};
}

void HandLight::dim(std::int64_t target_ns) { tracked_.presence = std::min(tracked_.presence, sight_.at(target_ns, in_sight_)); }

std::optional<LateRegistration::Hand> HandLight::to_register() const {
  return tracked_.has_landmarks && step_.registered > 0 ? std::optional(late_hand()) : std::nullopt;
}

LateRegistration::Hand HandLight::late_hand() const {
  LateRegistration::Hand hand{side_, &track_, tracked_.tracker, {}};
  for (int i = 0; i < kLandmarks; ++i) hand.offset_px[i] = tracked_.corrected[i] - tracked_.tracker[i];
  return hand;
}

void HandLight::correct_motion(LateRegistration& late, std::int64_t target_ns) {
  if (!tracked_.has_landmarks) return;
  if (tracked_.alone) {
    corrected_ = late.follow(late_hand(), target_ns, tracked_.news);
    return;
  }
  const auto registered = late.correct(late_hand(), target_ns, step_.registered);
  corrected_ = registered.points;
  moved_then_ = registered.moved_then;
  moved_now_ = registered.moved_target;
  if (step_.registered == 1) ladder_.registered(target_ns, registered.moved_target);
}

void HandLight::skin(float shading) {
  surface_.pose(tracked_.pose, settings_.skin, calibration_, shading, tracked_.presence);
  is_skinned_ = true;
}

LandmarkPoints HandLight::to_projector(const LandmarkPoints& camera_px) const {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) points[i] = calibration_.to_projector(camera_px[i]);
  return points;
}

int HandLight::correct() {
  if (!tracked_.has_landmarks) return 0;
  if (step_.moves < Rung::landmarks) {
    mover_.move(fit_rung(step_.moves, from_px(), to_px()), surface_.landings_px());
  } else {
    correct_vertices(settings_.correct, surface_.mesh(), from_px(), to_px(), surface_.landings_px());
  }
  return step_.moves >= Rung::fingers ? surface_.untangle() : 0;
}

void HandLight::learn_widths(std::int64_t target_ns, GreyView mask) {
  if (settings_.skin.fit && settings_.skin.widths && tracked_.has_landmarks) surface_.learn_widths(target_ns, to_px(), mask);
}

FrameHand HandLight::frame() const {
  FrameHand hand{side_, tracked_.tracker, corrected_, tracked_.has_landmarks, {}, step_.rung};
  if (is_skinned_) hand.landings = surface_.landings_px();
  return hand;
}

}  // namespace handcast::renderer
