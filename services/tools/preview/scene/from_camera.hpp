// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"

namespace handcast::preview {

/// The map from pixels of the camera's image to those of the projector that light them: lens
/// distortion, homography and, for a projector beside the camera, the depth of the hands. A table
/// of every 8th pixel of every 8th row, bilinear in between.
class FromCamera {
 public:
  /// Copies the calibration. Without hands all is at ProjectorModel::plane_m.
  explicit FromCamera(const calib::Calibration& calibration);

  /// Takes the joints of all hands: x and y in px of the image, z the distance along the camera's
  /// axis, m. What is between them is at a depth between theirs (inverse distance weighting,
  /// Shepard 1968).
  void place(std::vector<glm::vec3> joints);

  /// The projector pixel that lights this position of the image. Positions outside of the image
  /// are continued.
  glm::vec2 operator()(glm::vec2 image_px) const;
  /// The position of the image that a projector pixel lights; empty far outside of the image.
  std::optional<glm::vec2> image_px_of(glm::vec2 projector_px) const;

 private:
  double depth_at(glm::vec2 image_px) const;
  void fill_table();

  calib::Calibration calibration_;
  std::vector<glm::vec3> joints_;
  int columns_ = 0, rows_ = 0;
  std::vector<glm::dvec2> undistorted_;  ///< the pixels of the table
  std::vector<glm::vec2> table_;         ///< of the projector
};

}  // namespace handcast::preview
