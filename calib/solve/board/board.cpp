// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/board.hpp"

#include <fmt/format.h>

#include <cmath>

#include "calib/solve/board/pattern.hpp"

namespace handcast::calib {
namespace {

constexpr int kFewestInARow = 3, kMostInARow = 60;
constexpr double kSmallest_mm = 1, kLargest_mm = 1000;

/// The corners of both ends have the same colours if columns and rows are both even or both odd.
Result<void> check_checkerboard(const Board& board) {
  if ((board.columns + board.rows) % 2 != 0) return {};
  return fail(Errc::bad_config,
              fmt::format("A checkerboard of {} x {} squares looks the same upside down; choose an "
                          "even and an odd number, e.g. {} x {}.",
                          board.columns, board.rows, board.columns + 1, board.rows));
}

Result<void> check_circles(const Board& board) {
  if (board.columns != board.rows) return {};
  return fail(Errc::bad_config,
              fmt::format("The rows of {0} x {0} circles cannot be told from the columns; choose "
                          "two different numbers, e.g. {1} x {0}.",
                          board.rows, board.rows + 1));
}

Result<void> check_charuco(const Board& board) {
  const int markers = board.columns * board.rows / 2;
  if (markers <= kMarkers) return {};
  return fail(Errc::bad_config,
              fmt::format("A charuco board of {} x {} squares needs {} markers, but there are only "
                          "{}; choose fewer squares.",
                          board.columns, board.rows, markers, kMarkers));
}

}  // namespace

Result<void> check_board(const Board& board) {
  const auto fits = [](int count) { return count >= kFewestInARow && count <= kMostInARow; };
  if (!fits(board.columns) || !fits(board.rows))
    return fail(Errc::bad_config,
                fmt::format("A board of {} x {} is not possible; columns and rows must be between "
                            "{} and {}.",
                            board.columns, board.rows, kFewestInARow, kMostInARow));
  if (!(board.square_mm >= kSmallest_mm && board.square_mm <= kLargest_mm))
    return fail(Errc::bad_config,
                fmt::format("Squares of {} mm are not possible; their size must be between {} mm "
                            "and {} mm.",
                            board.square_mm, kSmallest_mm, kLargest_mm));
  switch (board.kind) {
    case BoardKind::checkerboard:
      return check_checkerboard(board);
    case BoardKind::circles:
      return check_circles(board);
    case BoardKind::charuco:
      return check_charuco(board);
  }
  return {};
}

std::vector<glm::dvec3> points_of(const Board& board) {
  const bool circles = board.kind == BoardKind::circles;
  const double first = circles ? 0.5 : 1;
  const int columns = board.columns - !circles, rows = board.rows - !circles;
  std::vector<glm::dvec3> points_m;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      points_m.push_back(glm::dvec3(column + first, row + first, 0) * (board.square_mm * 1e-3));
  return points_m;
}

}  // namespace handcast::calib
