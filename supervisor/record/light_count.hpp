// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "ipc/msg/light_source.hpp"

namespace handcast::supervisor {

/// What the output made of the frames of the projector.
struct LightCount {
  std::optional<msg::LightSource> source;  ///< who says when light comes; empty: none came
  std::uint64_t missed = 0;                ///< refreshes of the output without a new frame
  std::uint64_t doubled = 0;               ///< frames that were shown for more than one refresh

  /// Adds the light of a frame.
  void add(const msg::LightNote& note) {
    source = note.source;
    if (note.refreshes < 2) return;
    missed += note.refreshes - 1;
    ++doubled;
  }
};

}  // namespace handcast::supervisor
