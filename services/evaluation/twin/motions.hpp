// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "services/evaluation/twin/motion.hpp"
#include "services/evaluation/twin/recording.hpp"

/// The kinds of motion that open_motion chooses from.
namespace handcast::twin {

/// The names after "builtin:", comma separated.
std::string builtin_motion_names();

/// A motion made from angles and smooth functions of time, before the camera. Nothing: the name is
/// unknown.
std::unique_ptr<Motion> make_builtin_motion(std::string_view name, const config::Twin& settings,
                                            const calib::Calibration& calibration);

/// A recording, splined, played there and back.
std::unique_ptr<Motion> make_recorded_motion(const Recording& recording,
                                             const config::Twin& settings);

}  // namespace handcast::twin
