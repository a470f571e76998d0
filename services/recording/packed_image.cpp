// SPDX-License-Identifier: Apache-2.0
#include "services/recording/packed_image.hpp"

#include <algorithm>

namespace handcast::recording {
namespace {

/// RGBA pixels as four planes: red and blue as their difference from green, which they follow.
void split(std::span<const std::uint8_t> pixels, std::uint8_t* planes) {
  const auto count = pixels.size() / 4;
  const auto* from = pixels.data();
  auto *red = planes, *green = red + count, *blue = green + count, *alpha = blue + count;
  for (std::size_t i = 0; i < count; ++i) {
    red[i] = static_cast<std::uint8_t>(from[4 * i] - from[4 * i + 1]);
    green[i] = from[4 * i + 1];
    blue[i] = static_cast<std::uint8_t>(from[4 * i + 2] - from[4 * i + 1]);
    alpha[i] = from[4 * i + 3];
  }
}

void join(const std::uint8_t* planes, std::span<std::uint8_t> pixels) {
  const auto count = pixels.size() / 4;
  auto* to = pixels.data();
  const auto *red = planes, *green = red + count, *blue = green + count, *alpha = blue + count;
  for (std::size_t i = 0; i < count; ++i) {
    to[4 * i] = static_cast<std::uint8_t>(red[i] + green[i]);
    to[4 * i + 1] = green[i];
    to[4 * i + 2] = static_cast<std::uint8_t>(blue[i] + green[i]);
    to[4 * i + 3] = alpha[i];
  }
}

/// The upper neighbours of the first row of a plane are those of the last row of the plane before
/// it; those of the first plane are 0.
void subtract_upper(std::span<const std::uint8_t> from, std::size_t width, std::uint8_t* to) {
  std::copy_n(from.begin(), std::min(width, from.size()), to);
  for (std::size_t i = width; i < from.size(); ++i)
    to[i] = static_cast<std::uint8_t>(from[i] - from[i - width]);
}

void add_upper(std::span<std::uint8_t> image, std::size_t width) {
  for (std::size_t row = width; row < image.size(); row += width) {
    const auto* upper = &image[row - width];
    auto* here = &image[row];
    for (std::size_t x = 0; x < width; ++x) here[x] = static_cast<std::uint8_t>(here[x] + upper[x]);
  }
}

}  // namespace

void ImagePacker::append(std::span<const std::uint8_t> pixels, const ImageShape& shape,
                         Bytes& out) {
  const auto bytes = pixels.size();
  filtered_.resize(2 * bytes);
  auto planes = pixels;
  if (shape.channels > 1) {
    split(pixels, filtered_.data() + bytes);
    planes = std::span(filtered_).last(bytes);
  }
  subtract_upper(planes, shape.width_px, filtered_.data());
  deflater_.append(std::span(filtered_).first(bytes), out);
}

bool ImageUnpacker::read(std::span<const std::byte> packed, const ImageShape& shape,
                         std::span<std::uint8_t> pixels) {
  if (shape.channels <= 1) {
    if (!inflater_.read(packed, pixels)) return false;
    if (!pixels.empty()) add_upper(pixels, shape.width_px);
    return true;
  }
  filtered_.resize(pixels.size());
  if (!inflater_.read(packed, filtered_)) return false;
  if (!filtered_.empty()) add_upper(filtered_, shape.width_px);
  join(filtered_.data(), pixels);
  return true;
}

}  // namespace handcast::recording
