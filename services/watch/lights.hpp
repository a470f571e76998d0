// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "config/live/live_board.hpp"

namespace handcast::watch {

/// The light of a rig, and who changes it. One thread.
class Lights {
 public:
  explicit Lights(config::LiveBoard board) : board_(std::move(board)) {}

  /// Lets there be light, or none: light.blackout and, if the rig has a lamp, light.lamp. Errors:
  /// those of LiveBoard::set().
  Result<void> turn(bool on);

  /// A change of settings, if there was one since the last call.
  struct Change {
    std::string source, what;
  };
  std::optional<Change> look();
  /// Whether it is dark because somebody wants it so.
  bool is_dark() const { return is_dark_; }
  /// The rig file.
  const std::filesystem::path& rig_file() const { return board_.file(); }

 private:
  bool has_lamp() const { return !board_.filed().projector.lamp.pjlink.empty(); }

  config::LiveBoard board_;
  std::optional<std::uint64_t> seen_;  ///< number of the change that look() has seen last
  bool is_dark_ = false;
};

}  // namespace handcast::watch
