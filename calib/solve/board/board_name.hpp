// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// A board as a word: "charuco:11x8:20" has 11 x 8 squares of 20 mm.
std::string print_board_name(const Board& board);
/// Reads such a word. Errors: bad_config (it is none; those of check_board()).
Result<Board> parse_board(std::string_view name);

}  // namespace handcast::calib
