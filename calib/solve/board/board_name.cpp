// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/board/board_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::calib {
namespace {

/// Reads a number up to `end_character` (0: the end), and removes both. False if there is none.
template <class Number>
bool take_number(std::string_view& text, Number& number, char end_character) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc()) return false;
  if (end_character == 0) return read.ptr == end;
  if (read.ptr == end || *read.ptr != end_character) return false;
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()) + 1);
  return true;
}

}  // namespace

std::string print_board_name(const Board& board) {
  return fmt::format("{}:{}x{}:{:g}", words_of(board.kind)[static_cast<std::size_t>(board.kind)],
                     board.columns, board.rows, board.square_mm);
}

Result<Board> parse_board(std::string_view name) {
  constexpr auto kWords = words_of(BoardKind{});
  const auto colon = name.find(':');
  const auto word = std::ranges::find(kWords, name.substr(0, colon));
  Board board;
  auto rest = name.substr(colon == name.npos ? name.size() : colon + 1);
  if (word == kWords.end() || !take_number(rest, board.columns, 'x') ||
      !take_number(rest, board.rows, ':') || !take_number(rest, board.square_mm, 0))
    return fail(Errc::bad_config,
                fmt::format("{} is not a board like charuco:11x8:20 (kind, columns x rows, size "
                            "of a square in mm); the kinds are {}",
                            quote(name), join(kWords, ", ")));
  board.kind = static_cast<BoardKind>(word - kWords.begin());
  return check_board(board).map([&] { return board; });
}

}  // namespace handcast::calib
