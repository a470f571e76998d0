// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/fitting.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace handcast::init {
namespace {

using devices::Mode;

constexpr Size kReference{720, 540};
constexpr Size kEnough{640, 480};

bool contains(const Mode& mode, Size size) {
  return size.width_px >= mode.least_width_px && size.width_px <= mode.width_px &&
         size.height_px >= mode.least_height_px && size.height_px <= mode.height_px;
}

/// The size in the mode that is nearest to the reference rig's.
Images nearest(const Mode& mode) {
  return {mode.format,
          {std::clamp(kReference.width_px, mode.least_width_px, mode.width_px),
           std::clamp(kReference.height_px, mode.least_height_px, mode.height_px)},
          mode.rate_hz};
}

/// Less is better.
auto order_of(const Images& images) {
  const bool is_small =
      images.size.width_px < kEnough.width_px || images.size.height_px < kEnough.height_px;
  const long pixels = static_cast<long>(images.size.width_px) * images.size.height_px;
  const long off =
      std::labs(pixels - static_cast<long>(kReference.width_px) * kReference.height_px);
  return std::tuple(is_small, is_small ? off : 0, -images.rate_hz, off);
}

}  // namespace

std::optional<Images> fastest(const std::vector<Mode>& modes, Size size) {
  std::optional<Images> best;
  for (const auto& mode : modes)
    if (contains(mode, size) && (!best || mode.rate_hz > best->rate_hz))
      best = {mode.format, size, mode.rate_hz};
  return best;
}

Images recommended(const std::vector<Mode>& modes) {
  Images best = nearest(modes.front());
  for (const auto& mode : modes)
    if (const auto images = nearest(mode); order_of(images) < order_of(best)) best = images;
  return best;
}

}  // namespace handcast::init
