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
#include "renderer/hand/maker/hand_shape.hpp"

namespace handcast::twin {

using msg::Side;
using renderer::JointFrames;

/// Where the true joints are: a smooth function of time, the same whenever it is asked. Tracker
/// space, metres.
class Motion {
 public:
  virtual ~Motion() = default;
  /// The joints of one hand; nothing where this motion has no such hand.
  virtual std::optional<JointFrames> at(Side side, double seconds) const = 0;
  /// The person who moves: the true shape to which the mesh is fitted.
  virtual const renderer::HandShape& shape() const = 0;
};

/// `what`: "builtin:NAME" or a folder with a recording. Speed is applied; recordings loop (there
/// and back, so that they stay smooth). Errors (bad_config): unknown name (with the known ones),
/// folder or file missing, truncated or odd .npy (file named).
Result<std::unique_ptr<Motion>> open_motion(const config::Twin& settings,
                                            const calib::Calibration& calibration);

}  // namespace handcast::twin
