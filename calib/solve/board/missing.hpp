// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/solve/board/board.hpp"
#include "calib/solve/board/grey_view.hpp"

namespace handcast::calib {

/// Why a board is not found in an image, as a sentence for the person who holds it: what is in
/// front of the camera instead (columns and rows exchanged, inner corners counted instead of
/// squares, another size or kind of board, other markers, a mirrored image), or that the image is
/// dark or has no board. `wanted` must pass check_board(). Takes up to a few seconds. Any thread.
std::string why_missing(const Board& wanted, GreyView image);

}  // namespace handcast::calib
