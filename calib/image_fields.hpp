// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace handcast::calib {

/// What was seen where in an image, in 3 x 3 fields that a person can be sent to.
class ImageFields {
 public:
  ImageFields(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {}

  /// Counts the points that are inside the image.
  void add(const glm::dvec2& px);
  /// The field with the fewest points, as "top left" or "middle".
  std::string emptiest() const;
  /// The names of the fields with fewer points.
  std::vector<std::string> with_fewer_than(int points) const;

  static constexpr int kFields = 9;

 private:
  static constexpr int kSide = 3;

  int width_px_, height_px_;
  std::array<int, kFields> counts_{};  ///< row by row
};

}  // namespace handcast::calib
