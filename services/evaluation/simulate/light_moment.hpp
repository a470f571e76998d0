// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "calib/calibration.hpp"
#include "services/evaluation/simulate/simulation.hpp"
#include "services/evaluation/twin/twin.hpp"

namespace handcast::simulate {

/// How far the landmarks of one hand's light are off.
struct LandmarkErrors {
  std::array<double, msg::kLandmarks> px{}, mm{};  ///< camera px; mm at the joint's distance

  double mean_mm() const;
};
/// Nothing where there is no such hand.
std::optional<LandmarkErrors> landmark_errors(const renderer::FrameHand& hand, std::int64_t lit_ns,
                                              const twin::Twin& twin,
                                              const calib::Calibration& calibration);

/// The light at one moment.
struct LightMoment {
  double seconds = 0;
  double error_mm = 0;  ///< mean over the landmarks of the hand that is worst off
  bool dark = false;    ///< a hand that is there has no light at all
  int detections = 0;   ///< of a hand, that had arrived when this light was drawn
};
LightMoment moment_of(const Tick& tick, int detections, const twin::Twin& twin,
                      const calib::Calibration& calibration);

}  // namespace handcast::simulate
