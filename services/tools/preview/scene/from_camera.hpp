// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/base/image.hpp"

namespace handcast::preview {

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
