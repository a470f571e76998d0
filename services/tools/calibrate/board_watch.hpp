// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <future>
#include <optional>
#include <string>

#include "calib/solve/board/board_finder.hpp"

namespace handcast::calibrate {

/// Finds the board that a person holds, and says what is in front of the camera instead if it has
/// not been seen for some seconds. One thread; the reason is searched for on another one, which the
/// destructor waits for (a few seconds at most).
class BoardWatch {
 public:
  /// `board` must pass calib::check_board().
  explicit BoardWatch(const calib::Board& board);

  /// As calib::BoardFinder::find().
  std::optional<calib::BoardView> find(calib::GreyView image);
  /// Why the board is not seen; empty while it is, and until that is known.
  const std::string& why_missing() const { return why_; }

 private:
  calib::Board board_;
  calib::BoardFinder finder_;
  std::int64_t quiet_since_ns_;  ///< the board was seen, or a reason was found
  std::future<std::string> search_;
  std::string why_;
};

}  // namespace handcast::calibrate
