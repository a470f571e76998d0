// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/pose/lift/skeleton.hpp"

namespace handcast::pose {

/// The landmarks of a hand, and what each weighs.
struct SeenHand {
  std::array<glm::dvec2, msg::kLandmarks> px{};    ///< undistorted camera px
  std::array<double, msg::kLandmarks> sigma_px{};  ///< standard deviation; 0: not seen
};

/// The unknowns of a fit, in this order: rotation of the palm about the camera's axes (3), its x
/// and y (2), the logarithm of the size, then the angles, finger by finger.
inline constexpr int kPlaceUnknown = 3, kSizeUnknown = 5, kFirstAngle = 6;
inline constexpr int kUnknowns = kFirstAngle + kFingers * kAngles;
using Unknowns = std::array<double, kUnknowns>;

/// `posture`, changed by `step`.
Posture moved(Posture posture, const Unknowns& step);
/// The step from one posture to another. Rotations must differ by less than half a turn.
Unknowns difference(const Posture& from, const Posture& to);

/// What is known of a posture before the landmarks. The anatomy of a hand is always known, see
/// fit_posture().
struct Prior {
  Posture mean;               ///< the expected posture
  Unknowns variance{};        ///< of the posture about it; 0: nothing is known
  double usual_log_size = 0;  ///< of people's hands, with a standard deviation of 0.25
};

/// A posture and its cost.
struct Fit {
  Posture posture;      ///< the posture
  double cost = 0;      ///< half the sum of squared, normalised residuals (Huber's, beyond 3 sigma)
  Unknowns variance{};  ///< of the posture
};

/// The posture whose joints are projected onto the seen landmarks: nonlinear least squares
/// (Levenberg-Marquardt, at most `steps` steps from `start`) over `docs/method.md#lift`: the
/// landmarks, the prior, the usual angles and the limits of the joints. Distance and lengths of the
/// bones are given, so the foreshortening of a bone gives its depth; the limits decide between the
/// two solutions. A pure function.
Fit fit_posture(const Skeleton& skeleton, const calib::CameraModel& camera, double distance_m,
                const SeenHand& seen, const Prior& prior, const Posture& start, int steps);

/// Postures from which to fit a hand of which nothing is known: the palm as the image shows its
/// direction and its side, tilted in four ways, the fingers at rest. `log_size`: see Posture.
/// Landmarks that were not seen must have a place, too.
std::array<Posture, 4> starts_for(const Skeleton& skeleton, const calib::CameraModel& camera,
                                  double distance_m, const SeenHand& seen, double log_size);

/// The other posture of a palm that a distant camera could not distinguish: its depths are
/// mirrored. The fingers are at rest.
Posture mirrored_in_depth(const Posture& posture);

/// The posture with the fingers at rest.
Posture with_fingers_at_rest(Posture posture);

}  // namespace handcast::pose
