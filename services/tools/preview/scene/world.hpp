// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "renderer/base/image.hpp"
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

/// The map from pixels of the camera's image to pixels of the projector (lens distortion and
/// homography), as a table that is computed once per calibration.
class FromCamera {
 public:
  /// Computes the table.
  explicit FromCamera(const calib::Calibration& calibration);

  /// The projector pixel that lights this position of the image. Positions outside of the image
  /// are continued.
  glm::vec2 operator()(glm::vec2 image_px) const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<glm::vec2> table_;  ///< every 8th pixel of every 8th row; bilinear in between
};

}  // namespace handcast::preview
