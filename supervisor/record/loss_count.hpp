// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "ipc/msg/frame_losses.hpp"

namespace handcast::supervisor {

/// The images of the camera that were lost in a run, by reason. See msg::FrameLosses.
struct LossCount {
  std::uint64_t missing = 0, incomplete = 0, underrun = 0, skipped = 0;

  /// Adds what was lost before an image.
  void add(const msg::FrameLosses& lost) {
    missing += lost.missing;
    incomplete += lost.incomplete;
    underrun += lost.underrun;
    skipped += lost.skipped;
  }
  /// The counts with their names in reports.
  std::array<std::pair<std::string_view, std::uint64_t>, 4> by_reason() const {
    return {{{"missing", missing},
             {"incomplete", incomplete},
             {"underrun", underrun},
             {"skipped", skipped}}};
  }
};

}  // namespace handcast::supervisor
