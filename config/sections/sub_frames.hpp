// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/projector.hpp"

namespace handcast::config {

/// Number of sub-frames in an output frame.
constexpr int sub_frames_of(Packing packing) {
  switch (packing) {
    case Packing::planes_24x1:
      return 24;
    case Packing::planes_8x3:
      return 8;
    case Packing::quadrants_4:
      return 4;
    case Packing::quadrants_12:
      return 12;
    case Packing::none:
      break;
  }
  return 1;
}

/// True if a sub-frame has half the width and height of the output frame.
constexpr bool has_half_size(Packing packing) {
  return packing == Packing::quadrants_4 || packing == Packing::quadrants_12;
}

/// The settings of the output device, whose rate_hz counts output frames.
inline Projector output_of(const Projector& projector) {
  Projector output = projector;
  output.rate_hz /= sub_frames_of(projector.packing);
  return output;
}

}  // namespace handcast::config
