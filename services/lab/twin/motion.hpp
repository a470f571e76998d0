// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "ipc/base/result.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::twin {

using msg::Side;
using renderer::JointFrames;

/// The true joints of the hands as a smooth, pure function of time. Tracker space, metres.
class Motion {
 public:
  virtual ~Motion() = default;
  /// The joints of one hand at a time since the epoch; empty if the motion has no such hand then.
  virtual std::optional<JointFrames> at(Side side, double seconds) const = 0;
  /// The true shape of the person's hands, to which the mesh is fitted.
  virtual const renderer::HandShape& shape() const = 0;
};

/// Opens settings.motion, "builtin:NAME" or a folder with a recording, to be played at
/// settings.speed. A recording is played forwards and backwards in turn, which keeps it smooth.
/// Errors (bad_config): an unknown name (the message lists the known ones), a missing folder or
/// file, a truncated or malformed .npy file.
Result<std::unique_ptr<Motion>> open_motion(const config::Twin& settings,
                                            const calib::Calibration& calibration);

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
