// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "services/lab/twin/motion.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

/// The kinds of motion that open_motion chooses from.
namespace handcast::twin {

/// The names of the built-in motions, separated by commas.
std::string builtin_motion_names();

/// Makes a motion whose joint angles are smooth functions of time, in front of the camera. Returns
/// null if the name is unknown.
std::unique_ptr<Motion> make_builtin_motion(std::string_view name, const config::Twin& settings,
                                            const calib::Calibration& calibration);

/// Makes a motion from a recording: its spline, played forwards and backwards in turn.
std::unique_ptr<Motion> make_recorded_motion(const recording::RecordedHands& recording,
                                             const config::Twin& settings);

}  // namespace handcast::twin
