// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "calib/solve/board/board.hpp"
#include "calib/solve/board/grey_view.hpp"

namespace handcast::calib {

/// Finds a board in grey images, those of infrared cameras included: low contrast, noise, blur. A
/// checkerboard or a grid of circles must be visible as a whole; of a charuco board, 6 corners that
/// do not lie along one line suffice. Circles do not show which end is up: the board counts as
/// turned by less than a quarter turn.
class BoardFinder {
 public:
  /// `board` must pass check_board().
  explicit BoardFinder(const Board& board);
  ~BoardFinder();
  BoardFinder(BoardFinder&&) noexcept;
  BoardFinder& operator=(BoardFinder&&) noexcept;

  /// The points of the board, to a fraction of a pixel; nothing if it is not in the image. Any
  /// number of threads.
  std::optional<BoardView> find(GreyView image) const;

 private:
  struct Method;
  std::unique_ptr<const Method> method_;
};

}  // namespace handcast::calib
