// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "calib/calibration.hpp"
#include "services/lab/simulate/simulation.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::simulate {

/// Errors of the corrected landmarks of one hand.
struct LandmarkErrors {
  std::array<double, msg::kLandmarks> px{};  ///< camera px
  std::array<double, msg::kLandmarks> mm{};  ///< at the distance of the joint

  /// Mean over the landmarks.
  double mean_mm() const;
};
/// The errors of a hand whose light is on at `display_ns`; empty if there is no such true hand.
std::optional<LandmarkErrors> landmark_errors(const renderer::FrameHand& hand,
                                              std::int64_t display_ns, const twin::Twin& twin,
                                              const calib::Calibration& calibration);

/// Quality of the light of one projector frame.
struct LightMoment {
  double seconds = 0;   ///< time of the light, since the epoch
  double error_mm = 0;  ///< mean error of the landmarks of the worst hand
  bool dark = false;    ///< a true hand has no light
  int detections = 0;   ///< detections with a hand that had arrived when the frame was drawn
};
/// Measures one projector frame. `detections` is copied.
LightMoment moment_of(const Tick& tick, int detections, const twin::Twin& twin,
                      const calib::Calibration& calibration);

}  // namespace handcast::simulate
