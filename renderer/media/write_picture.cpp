// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spng.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/write_whole.hpp"
#include "renderer/media/picture.hpp"

namespace handcast::renderer {
namespace {

/// `pixels`: rows without padding.
Result<std::string> encoded(int width_px, int height_px, spng_color_type colours,
                            const std::vector<std::uint8_t>& pixels) {
  constexpr int kRunLengths = 3;  // Z_RLE: for images, the fastest, and small
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> png(spng_ctx_new(SPNG_CTX_ENCODER),
                                                                spng_ctx_free);
  for (const auto& [option, value] : {std::pair{SPNG_ENCODE_TO_BUFFER, 1},
                                      {SPNG_IMG_COMPRESSION_LEVEL, 1},
                                      {SPNG_IMG_COMPRESSION_STRATEGY, kRunLengths},
                                      {SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_UP}})
    spng_set_option(png.get(), option, value);
  spng_ihdr header{static_cast<std::uint32_t>(width_px),
                   static_cast<std::uint32_t>(height_px),
                   8,
                   static_cast<std::uint8_t>(colours),
                   0,
                   0,
                   0};
  spng_set_ihdr(png.get(), &header);
  int failed = spng_encode_image(png.get(), pixels.data(), pixels.size(), SPNG_FMT_PNG,
                                 SPNG_ENCODE_FINALIZE);
  std::size_t size = 0;
  const std::unique_ptr<void, decltype(&std::free)> bytes(
      failed ? nullptr : spng_get_png_buffer(png.get(), &size, &failed), std::free);
  if (failed)
    return fail(Errc::unavailable,
                fmt::format("The picture cannot be made: {}.", spng_strerror(failed)));
  return std::string(static_cast<const char*>(bytes.get()), size);
}

Result<void> write(const std::filesystem::path& file, const Result<std::string>& png) {
  if (!png) return fail_in(file.string(), png.error());
  return write_whole(file, *png, Durable::no);
}

}  // namespace

Result<void> write_png(const std::filesystem::path& file, View<const std::uint32_t> picture) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(picture.width) * picture.height * 3);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (const int shift : {0, 8, 16})
        rgb.push_back(static_cast<std::uint8_t>(picture.at(x, y) >> shift));
  return write(file, encoded(picture.width, picture.height, SPNG_COLOR_TYPE_TRUECOLOR, rgb));
}

Result<std::string> png_of(GreyView grey) {
  std::vector<std::uint8_t> rows;
  for (int y = 0; y < grey.height; ++y)
    rows.insert(rows.end(), grey.row(y), grey.row(y) + grey.width);
  return encoded(grey.width, grey.height, SPNG_COLOR_TYPE_GRAYSCALE, rows);
}

Result<void> write_png(const std::filesystem::path& file, GreyView grey) {
  return write(file, png_of(grey));
}

}  // namespace handcast::renderer
