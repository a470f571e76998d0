// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "ipc/base/result.hpp"
#include "services/camera/v4l2/format.hpp"

namespace handcast::camera::v4l2 {

/// Bytes that an uncompressed image needs up to the last grey value that is read. 0 for MJPEG.
std::size_t least_bytes(const Layout& layout);

/// Writes the grey values of an image to `grey` (layout.width_px * layout.height_px values, row by
/// row without gaps). GREY: as they are. Y10, Y16 (little-endian): the 8 highest bits. YUYV, NV12:
/// the luma, in the range that the camera uses. MJPEG: the luma; the Huffman tables may be missing,
/// as they are in the streams of most webcams. Errors: bad_data (`bytes` end too early, or are not
/// a JPEG image of this size).
Result<void> to_grey(const Layout& layout, std::span<const std::uint8_t> bytes,
                     std::span<std::uint8_t> grey);

}  // namespace handcast::camera::v4l2
