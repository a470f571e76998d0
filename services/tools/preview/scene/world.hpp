// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::preview {

/// What the messages of a rig refer to: its geometry, its settings and the meshes that it draws.
struct World {
  calib::Calibration calibration;                        ///< of camera, tracker and projector
  config::Mask mask;                                     ///< settings of the mask
  config::Predict predict;                               ///< settings of the prediction
  std::array<renderer::HandMesh, msg::kMaxHands> hands;  ///< by side
};

/// Reads the files that a rig names. Errors: bad_config.
Result<World> load_world(const config::Rig& rig);

}  // namespace handcast::preview
