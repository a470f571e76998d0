// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::camera::leap {

/// A size of the images of one eye and how the camera calls it.
struct StreamMode {
  int width_px = 0;         ///< columns of one eye
  int height_px = 0;        ///< rows
  double rate_hz = 0;       ///< the highest
  std::uint32_t ticks = 0;  ///< of 100 ns from image to image at that rate
  std::uint8_t format = 0;  ///< number of the format
  std::uint8_t frame = 0;   ///< number of the size in it

  /// Bytes of an image of both eyes.
  std::size_t bytes() const {
    return 2 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
};

/// What a camera's descriptors say of its stream.
struct StreamDescription {
  std::vector<StreamMode> modes;  ///< with two bytes per pixel: one of each eye
  std::uint32_t clock_hz = 0;     ///< ticks of the stamps in a second; 0: it does not say
};

/// Reads the class-specific descriptors of the video control and the video streaming interface, one
/// after the other in any order (USB Device Class Definition for Video Devices 1.0, sections 3.7
/// and 3.9; Payload Uncompressed 1.0, section 3.1). Descriptors of other types, and sizes that
/// cannot be images, are left out. Errors: bad_data (no size is left; a descriptor is cut off).
Result<StreamDescription> parse_descriptors(std::span<const std::uint8_t> control,
                                            std::span<const std::uint8_t> streaming);

/// The mode for images of a size at a rate: one of this size or, if that is too slow, one with half
/// or a quarter of the rows. If none is fast enough, half of the rows. Errors: bad_config (there is
/// none of this size or half of it; the sentence names those that there are).
Result<StreamMode> mode_of(const StreamDescription& description, int width_px, int height_px,
                           double rate_hz);

}  // namespace handcast::camera::leap
