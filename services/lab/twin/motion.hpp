// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "ipc/base/result.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"

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

}  // namespace handcast::twin
