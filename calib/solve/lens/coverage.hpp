// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// How the board is tilted against the image, without a calibration: by how much its distance grows
/// to the right and downwards in the image, about the tangent of the angle. `scale_px`: a guess of
/// the focal length. Nothing if the points do not determine it.
std::optional<glm::dvec2> tilt_of(const BoardView& view, double scale_px);

/// A focal length for tilt_of(), when nothing is known of the lens.
inline double usual_focal_length_px(int width_px) { return 1.3 * width_px; }

/// The largest distance of a corner from where the homography that fits the board best has it, as a
/// share of the distance between neighbours; infinite if there is no homography.
double mistake_of(const BoardView& view);

/// How a board is held, as seen in the image: its back tilts away on that side. Towards a corner it
/// is tilted to two sides.
enum class Tilt { flat, left, right, up, down };
constexpr std::array<std::string_view, 5> words_of(Tilt) {
  return {"flat", "left", "right", "up", "down"};
}

/// Where in the image the board has been, and how it was tilted; what is still missing.
class Coverage {
 public:
  static constexpr int kColumns = 6, kRows = 5;  ///< of the cells of the image

  Coverage(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {}

  void add(const BoardView& view);

  /// Number of views with a corner in a cell; columns from the left, rows from the top.
  int views_in(int column, int row) const { return cells_[index(column, row)]; }
  int views_with(Tilt tilt) const { return tilts_[static_cast<std::size_t>(tilt)]; }

  /// The share of the cells in which there was a corner.
  double area() const;
  /// How much of what a calibration needs there is: 1 if all cells and all tilts were seen.
  double share() const;
  /// What the person should do next, one sentence for the largest gap; empty if nothing is missing.
  std::string advice() const;

 private:
  static std::size_t index(int column, int row) {
    const int cell = row * kColumns + column;
    return static_cast<std::size_t>(cell);
  }
  int tilts_seen() const;
  std::string place_advice() const;

  int width_px_, height_px_;
  std::array<int, kColumns * kRows> cells_{};
  std::array<int, 5> tilts_{};
};

}  // namespace handcast::calib
