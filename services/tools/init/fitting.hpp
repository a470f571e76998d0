// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "services/tools/devices/attached.hpp"

namespace handcast::init {

/// A size in pixels.
struct Size {
  int width_px = 0, height_px = 0;
  bool operator==(const Size&) const = default;
};

/// Images of one size.
struct Images {
  std::string format;  ///< as in a rig file; empty: nothing to choose
  Size size;
  double rate_hz = 0;  ///< 0: the device does not say
};

/// The fastest images of this size. nullopt: there are none.
std::optional<Images> fastest(const std::vector<devices::Mode>& modes, Size size);

/// What a camera that is not calibrated yet should send: the fastest images of at least 640x480, of
/// equally fast ones those nearest to the size of the reference rig; the largest ones if all are
/// smaller. `modes`: at least one.
Images recommended(const std::vector<devices::Mode>& modes);

}  // namespace handcast::init
