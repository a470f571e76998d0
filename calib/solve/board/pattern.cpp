// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/pattern.hpp"

#include <opencv2/aruco/dictionary.hpp>

namespace handcast::calib {
namespace {

constexpr int kModules = 6;  ///< of a marker's side: 4 bits and the border

/// The black modules of a marker; those side by side make one rectangle.
void add_marker(int id, glm::dvec2 centre, std::vector<Shape>& shapes) {
  static const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_250);
  cv::Mat_<std::uint8_t> marker;
  dictionary->drawMarker(id, kModules, marker);
  const double side = kMarkerShare / kModules;
  const glm::dvec2 corner = centre - kMarkerShare / 2;
  for (int row = 0; row < kModules; ++row)
    for (int begin = 0, end; begin < kModules; begin = end + 1) {
      for (end = begin; end < kModules && marker(row, end) == 0;) ++end;
      if (end == begin) continue;
      shapes.push_back({corner + glm::dvec2(begin + end, 2 * row + 1) * (side / 2),
                        glm::dvec2(end - begin, 1) * (side / 2)});
    }
}

}  // namespace

std::vector<Shape> pattern_of(const Board& board) {
  std::vector<Shape> shapes;
  int marker = 0;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const glm::dvec2 centre(column + 0.5, row + 0.5);
      if (board.kind == BoardKind::circles)
        shapes.push_back({centre, glm::dvec2(kCircleRadius), true});
      else if ((row + column) % 2 == 0)
        shapes.push_back({centre, glm::dvec2(0.5)});
      else if (board.kind == BoardKind::charuco)
        add_marker(marker++, centre, shapes);
    }
  return shapes;
}

}  // namespace handcast::calib
