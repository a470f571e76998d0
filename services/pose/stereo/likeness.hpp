// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {

/// How alike the pictures of a hand are in both views, and so the errors of its landmarks.
struct Likeness {
  double correlation = 0;       ///< of the errors of one landmark, 0 to 0.95
  double cosine = 1, sine = 0;  ///< of the roll of the second camera relative to the first

  /// A vector in the second view's image, along the axes of the first's.
  glm::dvec2 as_first(const glm::dvec2& v) const {
    return {cosine * v.x + sine * v.y, cosine * v.y - sine * v.x};
  }
};

/// Of a hand at this place in the space of the first camera: the smaller the angle between the
/// lines of sight, the more alike are the pictures.
Likeness likeness_of(const Views& views, const glm::dvec3& hand_m);

}  // namespace handcast::pose::stereo
