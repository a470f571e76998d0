// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// The board as a PDF file of one page, at true scale: the pattern, under it a ruler of 100 mm and
/// a caption. The page is A4 or A3, upright or not, or larger if the board needs it.
std::string board_pdf(const Board& board);

}  // namespace handcast::calib
