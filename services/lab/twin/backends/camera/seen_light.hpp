// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "config/sections/projector.hpp"
#include "ipc/msg/projection.hpp"
#include "services/lab/twin/flat_picture.hpp"

namespace handcast::camera {

/// The light 0..255 that the true projector makes of the levels 0..255 of a frame.
using TrueLight = std::array<std::uint8_t, 256>;

/// For a projector with these settings, which may be wrong about its gamma. `true_gamma`: 0 as in
/// sRGB, else the exponent.
TrueLight true_light(const config::Projector& settings, double true_gamma);

/// The test pictures that the rig's projector has shown lately, as light on the twin's board. Hands
/// count as dark. One thread.
class SeenLight {
 public:
  /// `late_ns`: how much later than reported the light comes. `period_ns`: how long a frame is lit;
  /// the reported time is the middle of it.
  SeenLight(std::int64_t late_ns, std::int64_t period_ns, const TrueLight& light);

  /// Adds what was projected; in the order of its light.
  void add(const msg::Projection& projection);
  /// The mean light of an exposure around `middle_ns`, CLOCK_MONOTONIC; empty if it is dark. Valid
  /// until the next call.
  std::optional<twin::Light> during(std::int64_t middle_ns, std::int64_t exposure_ns);

 private:
  struct Lit {
    std::int64_t from_ns = 0;
    std::uint64_t test_picture = 0;
    int width_px = 0, height_px = 0;
    std::vector<std::uint8_t> grey;  ///< empty: dark
  };
  /// A picture and its share of an exposure.
  struct Part {
    const Lit* lit;
    double share;
  };

  std::vector<Part> parts_of(std::int64_t from_ns, std::int64_t to_ns) const;

  std::int64_t late_ns_, period_ns_;
  TrueLight light_;
  std::deque<Lit> lit_;            ///< in order of time
  std::vector<std::uint8_t> mix_;  ///< of several pictures in one exposure
};

}  // namespace handcast::camera
