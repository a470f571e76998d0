// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "ipc/base/quote.hpp"
#include "services/lab/twin/choreography.hpp"
#include "services/lab/twin/person.hpp"

namespace handcast::twin {

Result<std::unique_ptr<Motion>> open_motion(const config::Twin& settings,
                                            const calib::Calibration& calibration) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (settings.motion.starts_with(kBuiltin)) {
    const std::string name = settings.motion.substr(kBuiltin.size());
    auto motion = make_builtin_motion(name, settings, calibration);
    if (!motion)
      return fail(Errc::bad_config,
                  fmt::format("twin.motion: there is no built-in motion {}; choose one of {}",
                              quote(name), builtin_motion_names()));
    return motion;
  }
  if (!std::filesystem::is_directory(settings.motion))
    return fail(
        Errc::bad_config,
        fmt::format("twin.motion: {} is not a folder; a built-in motion is builtin:NAME, with "
                    "NAME one of {}",
                    quote(settings.motion), builtin_motion_names()));
  const auto recording = recording::read_recording(settings.motion);
  if (!recording) return fail_in("twin.motion", Error{Errc::bad_config, recording.error().what});
  return make_recorded_motion(*recording, settings);
}

namespace {

/// Width of the camera's field of view at the hand, which is 0.73 m away on the reference rig.
constexpr double kView_m = 0.452;
constexpr double kForearm_m = 0.25;  ///< wrist to elbow

class BuiltinMotion final : public Motion {
 public:
  BuiltinMotion(const Choreography& choreography, const config::Twin& settings,
                const calib::Calibration& calibration)
      : choreography_(choreography),
        speed_(settings.speed),
        camera_(calibration.camera),
        tracker_from_camera_(glm::inverse(calibration.camera_from_tracker)),
        shape_(draw_person(settings.shape, settings.seed)),
        articulation_(shape_) {}

  std::optional<JointFrames> at(Side side, double seconds) const override {
    const bool right = side == Side::right;
    if (right && !choreography_.both_hands) return std::nullopt;
    const Posture posture =
        choreography_.at(seconds * speed_ + (right ? choreography_.right_ahead_s : 0));
    if (posture.gone) return std::nullopt;
    return articulation_.frames(side, tracker_from_camera_ * camera_from_wrist(side, posture),
                                posture.bend);
  }

  const renderer::HandShape& shape() const override { return shape_; }

 private:
  /// Position of the wrist at rest: below the middle of the image, or beside the other hand's.
  glm::dvec3 home(Side side) const {
    const double z = kView_m * camera_.fx_px / camera_.width_px;
    double across = 0.49;
    if (choreography_.both_hands) across = side == Side::left ? 0.235 : 0.765;
    const glm::dvec2 px(across * camera_.width_px, 0.82 * camera_.height_px);
    return {(px.x - camera_.cx_px) / camera_.fx_px * z, (px.y - camera_.cy_px) / camera_.fy_px * z,
            z};
  }

  /// Position of the wrist on its way to the other hand's place.
  glm::dvec3 way(Side side, double over) const {
    if (over == 0) return home(side);
    constexpr double kApart_m = 0.1;  // along the camera's axis, half-way
    const Side other = side == Side::left ? Side::right : Side::left;
    const double aside_m = 4 * over * (1 - over) * kApart_m / 2 * (side == Side::left ? -1 : 1);
    return glm::mix(home(side), home(other), over) + glm::dvec3(0, 0, aside_m);
  }

  glm::dmat4 camera_from_wrist(Side side, const Posture& posture) const {
    const double mirror = side == Side::left ? 1 : -1;
    glm::dmat4 m = glm::translate(glm::dmat4(1), way(side, posture.over) + posture.shift);
    m = glm::translate(m, {0, kForearm_m, 0});
    m = glm::rotate(m, posture.sway, {0, 0, 1});
    m = glm::translate(m, {0, -kForearm_m, 0});
    // The elbow is nearer to the camera than the hand, as on the reference rig. Radians.
    constexpr double kElbowNearer = 0.15;
    m = glm::rotate(m, posture.nod + kElbowNearer, {-1, 0, 0});
    m = glm::rotate(m, mirror * posture.turn, {0, 1, 0});
    // Hand axes in the image: y to the camera, z down.
    return m * glm::dmat4(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  }

  const Choreography& choreography_;
  double speed_;
  calib::CameraModel camera_;
  glm::dmat4 tracker_from_camera_;
  renderer::HandShape shape_;
  Articulation articulation_;
};

}  // namespace

std::string builtin_motion_names() {
  std::string names;
  for (const auto& choreography : choreographies()) {
    if (!names.empty()) names += ", ";
    names += choreography.name;
  }
  return names;
}

std::unique_ptr<Motion> make_builtin_motion(std::string_view name, const config::Twin& settings,
                                            const calib::Calibration& calibration) {
  for (const auto& choreography : choreographies())
    if (choreography.name == name)
      return std::make_unique<BuiltinMotion>(choreography, settings, calibration);
  return nullptr;
}

}  // namespace handcast::twin
