// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A threshold that follows the light over the hand. One threshold for a whole hand is too high for
/// a finger or a side that is lit at a grazing angle, and too low beside the brightest skin. Here
/// each cell of 16 x 16 pixels and its neighbours have a dark and a bright mean, separated by the
/// global threshold, and the threshold is a third of the way between them; pixels between the
/// centres of cells get an interpolated value. One thread.
class LocalThreshold {
 public:
  /// Allocates the memory for images of this size in pixels.
  void reserve(int width, int height);
  /// Measures `region`, which must be inside the image. With pixels on one side of `threshold` only
  /// it holds everywhere.
  void measure(GreyView image, const Rect& region, int threshold);
  /// The thresholds of the pixels of row `y` from `x0` to the end of the region, which must hold
  /// the pixel. Adjacent rows share them. Valid until the next call.
  const std::uint8_t* row(int y, int x0);
  /// The threshold of one pixel of the region: as row(), before it is rounded down.
  float at(int x, int y) const;

 private:
  /// Sums over the sampled pixels of a cell.
  struct Cell {
    float dark = 0, bright = 0;  ///< of grey values
    float dark_count = 0, bright_count = 0;
  };

  void sample(GreyView image, int threshold);
  static void add_neighbours(Cell* cells, int count, int step);
  std::size_t index(int column, int line) const {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void interpolate(int y);
  float at_centre(int column, int y) const;

  Rect region_;
  int columns_ = 0, lines_ = 0;
  std::vector<Cell> cells_;
  std::vector<float> thresholds_, line_;  ///< by cell; and at the centres of the cells of one row
  std::vector<std::uint8_t> row_;
  int row_y_ = -1;  ///< first of the rows that row_ is for
};

}  // namespace handcast::renderer
