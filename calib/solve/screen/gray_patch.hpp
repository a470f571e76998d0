// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "calib/solve/screen/correspondence.hpp"

/// From the edges of stripes in a small part of the camera's image to one correspondence.
namespace handcast::calib {

/// Least squares: a coordinate of the projector as an affine function of the camera pixel.
struct AffineSums {
  glm::dmat3 normal{0};
  glm::dvec3 right{0};
  double square = 0;
  int count = 0;

  void add(const glm::dvec2& px, double value, double weight) {
    const glm::dvec3 row(px, 1);
    normal += weight * glm::outerProduct(row, row);
    right += weight * value * row;
    square += weight * value * value;
    ++count;
  }
};

/// The edges in a patch; pixels are relative to its first one.
struct Patch {
  AffineSums column, row;
};

/// A patch that was read; its point's sigma_px holds if `misfit` is 1.
struct PatchReading {
  Correspondence point;
  double misfit = 0;  ///< root mean square of the edges' residuals in standard deviations
  double rms_px = 0;  ///< of the residuals, in camera px
};

/// Reads the projector's coordinates at the edges' centre. `first_px`: the patch's first pixel.
/// Nothing if there are too few edges.
std::optional<PatchReading> read_patch(const Patch& patch, const glm::dvec2& first_px);

}  // namespace handcast::calib
