// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "ipc/msg/projection.hpp"
#include "services/evaluation/twin/flat_picture.hpp"

namespace handcast::camera {

/// The test pictures that the rig's projector has shown lately, as light on the twin's board. Hands
/// count as dark. One thread.
class SeenLight {
 public:
  /// `late_ns`: how much later than reported the light comes.
  explicit SeenLight(std::int64_t late_ns) : late_ns_(late_ns) {}

  /// Adds what was projected; in the order of its light.
  void add(const msg::Projection& projection);
  /// The light at a time, CLOCK_MONOTONIC; empty if it is dark. Valid until the next add().
  std::optional<twin::Light> at(std::int64_t time_ns) const;

 private:
  struct Lit {
    std::int64_t from_ns = 0;
    std::uint64_t test_picture = 0;
    int width_px = 0, height_px = 0;
    std::vector<std::uint8_t> grey;  ///< empty: dark
  };

  std::int64_t late_ns_;
  std::deque<Lit> lit_;  ///< in order of time
};

}  // namespace handcast::camera
