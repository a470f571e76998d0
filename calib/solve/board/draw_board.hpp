// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/board/board.hpp"
#include "calib/solve/board/grey_view.hpp"

namespace handcast::calib {

/// The board in black on white, with a margin of half a square on each side: (columns + 1) x (rows
/// + 1) squares. The origin of board space lies at px_per_square / 2 - 0.5 px in both directions,
/// (0, 0) being the centre of the top left pixel. Edges that cut pixels are grey.
GreyPicture draw_board(const Board& board, int px_per_square);

}  // namespace handcast::calib
