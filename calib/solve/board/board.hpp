// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::calib {

enum class BoardKind {
  checkerboard,  ///< squares; the top left one is black
  circles,       ///< black circles on a symmetric grid
  charuco,       ///< a checkerboard with ArUco markers in its white squares
};
constexpr std::array<std::string_view, 3> words_of(BoardKind) {
  return {"checkerboard", "circles", "charuco"};
}

/// A printed calibration board. Board space: x to the right and y down in the printed picture, z
/// into the paper, in metres; the origin is the top left corner of the pattern, which does not
/// include the white margin.
///
/// Points and their ids, row by row from the top left: the inner corners of the squares
/// (checkerboard, charuco), or the centres of the circles. The pattern of circles has half a pitch
/// of white around the outer centres. The markers of charuco are those of DICT_4X4_250 in the
/// layout of OpenCV from 4.6 on (the top left square is black), 3/4 as wide as a square.
struct Board {
  BoardKind kind = BoardKind::charuco;
  int columns = 11, rows = 8;  ///< of squares or circles
  double square_mm = 20;       ///< side of a square; pitch of the circles
};

/// Errors: bad_config (a size is out of range; the board looks the same when it is turned by half a
/// turn, or its rows cannot be told from its columns).
Result<void> check_board(const Board& board);

/// Where the points are, in board space; the id is the index.
std::vector<glm::dvec3> points_of(const Board& board);

/// What was found of a board in an image: the same number of elements in each list.
struct BoardView {
  std::vector<int> ids;
  std::vector<glm::dvec2> image_px;  ///< with the lens's distortion; (0, 0): centre of the top
                                     ///< left pixel
  std::vector<glm::dvec3> board_m;   ///< in board space; z is 0
};

}  // namespace handcast::calib
