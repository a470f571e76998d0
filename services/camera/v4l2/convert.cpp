// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/convert.hpp"

#include <fmt/format.h>

#include <cstring>

#include "renderer/base/clones.hpp"
#include "renderer/media/jpeg.hpp"

namespace handcast::camera::v4l2 {
namespace {

using config::WebcamFormat;

/// The bytes 0, 2, 4, ... of `from`.
HANDCAST_CLONES
void copy_even_bytes(const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[2 * i];
}

/// Little-endian words of 10 bits. A camera may leave anything in the 6 bits above them.
HANDCAST_CLONES
void copy_high_of_10_bits(const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = static_cast<std::uint8_t>(from[2 * i] >> 2 | from[2 * i + 1] << 6);
}

void convert_row(WebcamFormat format, const std::uint8_t* from, std::uint8_t* to,
                 std::size_t width) {
  if (format == WebcamFormat::y10) return copy_high_of_10_bits(from, to, width);
  if (format == WebcamFormat::yuyv) return copy_even_bytes(from, to, width);
  if (format != WebcamFormat::y16)
    std::memcpy(to, from, width);
  else if (width > 0) {
    copy_even_bytes(from + 1, to, width - 1);
    to[width - 1] = from[2 * width - 1];
  }
}

}  // namespace

std::size_t least_bytes(const Layout& layout) {
  const std::size_t pixel = bytes_per_pixel(layout.format);
  if (pixel == 0 || layout.height_px <= 0) return 0;
  return layout.bytes_per_row * (layout.height_px - 1) + pixel * layout.width_px;
}

Result<void> to_grey(const Layout& layout, std::span<const std::uint8_t> bytes,
                     std::span<std::uint8_t> grey) {
  const auto width = static_cast<std::size_t>(layout.width_px);
  if (layout.format == WebcamFormat::mjpeg) {
    auto decoded = renderer::decode_grey_jpeg(
        bytes, {grey.data(), layout.width_px, layout.height_px, layout.width_px});
    if (!decoded) decoded.error().what = "an image " + decoded.error().what;
    return decoded;
  }
  if (bytes.size() < least_bytes(layout))
    return fail(Errc::bad_data, fmt::format("an image has {} bytes instead of {}", bytes.size(),
                                            least_bytes(layout)));
  for (int y = 0; y < layout.height_px; ++y)
    convert_row(layout.format, bytes.data() + y * layout.bytes_per_row, grey.data() + y * width,
                width);
  return {};
}

}  // namespace handcast::camera::v4l2
