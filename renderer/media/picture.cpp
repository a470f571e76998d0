// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/picture.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/input_file.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/base/srgb.hpp"
#include "renderer/media/jpeg.hpp"

namespace handcast::renderer {
namespace {

constexpr std::uint32_t kOpaque = 0xff000000u;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
/// Memory for the chunks of a file beside its pixels, which may be packed to a thousandth.
constexpr std::size_t kMostChunks = 16 << 20;
constexpr double kScreenGamma = 2.2;

/// The bytes without the chunks of text, which the decoder would inflate: thousands of them can
/// take minutes. Bytes that are no chunks are left to the decoder.
std::string without_texts(std::string_view bytes) {
  constexpr std::size_t kFrame = 12;  // length, type and checksum of a chunk
  std::string kept(bytes.substr(0, kPngSignature.size()));
  bytes.remove_prefix(kept.size());
  while (bytes.size() >= kFrame) {
    std::size_t length = kFrame;
    for (int i = 0; i < 4; ++i)
      length += std::size_t{static_cast<std::uint8_t>(bytes[i])} << (24 - 8 * i);
    const auto type = bytes.substr(4, 4), chunk = bytes.substr(0, length);
    if (type != "tEXt" && type != "zTXt" && type != "iTXt") kept += chunk;
    bytes.remove_prefix(chunk.size());
  }
  return kept += bytes;
}

/// A PNG file whose header has been read.
struct PngFile {
  std::unique_ptr<const std::string> bytes;  ///< which the decoder reads
  std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> png;
  spng_ihdr header{};
  double gamma = 0;  ///< 0 if the values are those of sRGB

  bool is_plain_grey() const {
    spng_trns transparency;
    return header.color_type == SPNG_COLOR_TYPE_GRAYSCALE && header.bit_depth <= 8 && gamma == 0 &&
           spng_get_trns(png.get(), &transparency) != 0;
  }
};

tl::unexpected<Error> broken(const std::filesystem::path& file) {
  return fail(Errc::bad_config, fmt::format("'{}' is not a PNG picture.", file.string()));
}

double gamma_of(spng_ctx* png, int bit_depth) {
  std::uint8_t intent = 0;
  double gamma = 0;
  if (spng_get_srgb(png, &intent) == 0) return 0;
  if (spng_get_gama(png, &gamma) != 0) return bit_depth == 16 ? 1 : 0;
  constexpr double kSame = 0.05;
  return std::abs(gamma * kScreenGamma - 1) < kSame ? 0 : gamma;
}

Result<PngFile> open_png(std::string_view bytes, const std::filesystem::path& file) {
  PngFile opened{std::make_unique<const std::string>(without_texts(bytes)),
                 {spng_ctx_new(0), spng_ctx_free}};
  auto* png = opened.png.get();
  spng_set_chunk_limits(png, kMostPicture, kMostChunks);
  spng_set_png_buffer(png, opened.bytes->data(), opened.bytes->size());
  if (spng_get_ihdr(png, &opened.header) != 0) return broken(file);
  const auto width = opened.header.width, height = opened.header.height;
  if (std::max(width, height) > kLargestSide)
    return fail(Errc::bad_config,
                fmt::format("The picture '{}' is {}x{} px; at most {} px per side are allowed.",
                            file.string(), width, height, kLargestSide));
  opened.gamma = gamma_of(png, opened.header.bit_depth);
  return opened;
}

template <class Pixel>
Result<Image<Pixel>> decode_as(spng_format format, const PngFile& opened,
                               const std::filesystem::path& file) {
  Image<Pixel> image(static_cast<int>(opened.header.width), static_cast<int>(opened.header.height));
  const auto bytes = image.pixels().size() * sizeof(Pixel);
  if (spng_decode_image(opened.png.get(), image.row(0), bytes, format, SPNG_DECODE_TRNS) != 0)
    return broken(file);
  return image;
}

/// The levels on the screen of all values of 16 bits.
std::vector<std::uint8_t> levels_of(double gamma) {
  std::vector<std::uint8_t> levels(1 << 16);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double value = static_cast<double>(i) / 65535;
    const double level = gamma == 1 ? srgb_level(value) : std::pow(value, 1 / gamma / kScreenGamma);
    levels[i] = static_cast<std::uint8_t>(std::lround(255 * level));
  }
  return levels;
}

Result<Texture> decode_colours(const PngFile& opened, const std::filesystem::path& file) {
  if (opened.gamma == 0) return decode_as<std::uint32_t>(SPNG_FMT_RGBA8, opened, file);
  const auto wide = decode_as<std::array<std::uint16_t, 4>>(SPNG_FMT_RGBA16, opened, file);
  if (!wide) return tl::make_unexpected(wide.error());
  const auto levels = levels_of(opened.gamma);
  Texture picture(wide->width(), wide->height());
  std::ranges::transform(wide->pixels(), picture.pixels().begin(), [&](const auto& rgba) {
    return static_cast<std::uint32_t>(levels[rgba[0]] | levels[rgba[1]] << 8 |
                                      levels[rgba[2]] << 16) |
           static_cast<std::uint32_t>(rgba[3] >> 8) << 24;
  });
  return picture;
}

Image<std::uint8_t> luminance_of(const Texture& picture) {
  std::array<double, 256> light;
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = srgb_light(static_cast<double>(i) / 255);
  Image<std::uint8_t> grey(picture.width(), picture.height());
  std::ranges::transform(picture.pixels(), grey.pixels().begin(), [&](std::uint32_t rgba) {
    const auto part = [&](int shift) { return rgba >> shift & 255; };
    const double luminance =  // ITU-R BT.709
        0.2126 * light[part(0)] + 0.7152 * light[part(8)] + 0.0722 * light[part(16)];
    return static_cast<std::uint8_t>(std::lround(255 * srgb_level(luminance * part(24) / 255)));
  });
  return grey;
}

/// `pixels`: rows without padding.
Result<void> write_png(const std::filesystem::path& file, int width_px, int height_px,
                       spng_color_type colours, const std::vector<std::uint8_t>& pixels) {
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
    return fail(Errc::unavailable, fmt::format("The picture '{}' cannot be made: {}.",
                                               file.string(), spng_strerror(failed)));
  return write_whole(file, {static_cast<const char*>(bytes.get()), size}, Durable::no);
}

}  // namespace

Result<Texture> read_picture(const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostPicture);
  if (!bytes) return fail_in("picture", bytes.error());
  if (!bytes->starts_with(kPngSignature)) {
    auto texture = decode_jpeg(*bytes);
    if (texture) return texture;
    return fail(Errc::bad_config, fmt::format("'{}' {}.", file.string(), texture.error().what));
  }
  const auto opened = open_png(*bytes, file);
  if (!opened) return tl::make_unexpected(opened.error());
  auto picture = decode_colours(*opened, file);
  if (picture)
    for (auto& pixel : picture->pixels()) pixel |= kOpaque;
  return picture;
}

Result<Image<std::uint8_t>> read_grey_png(const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostPicture);
  if (!bytes) return fail_in("picture", bytes.error());
  const auto opened = open_png(*bytes, file);
  if (!opened) return tl::make_unexpected(opened.error());
  if (opened->is_plain_grey()) return decode_as<std::uint8_t>(SPNG_FMT_G8, *opened, file);
  return decode_colours(*opened, file).map(luminance_of);
}

Result<void> write_png(const std::filesystem::path& file, View<const std::uint32_t> picture) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(picture.width) * picture.height * 3);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (const int shift : {0, 8, 16})
        rgb.push_back(static_cast<std::uint8_t>(picture.at(x, y) >> shift));
  return write_png(file, picture.width, picture.height, SPNG_COLOR_TYPE_TRUECOLOR, rgb);
}

Result<void> write_png(const std::filesystem::path& file, GreyView grey) {
  std::vector<std::uint8_t> rows;
  for (int y = 0; y < grey.height; ++y)
    rows.insert(rows.end(), grey.row(y), grey.row(y) + grey.width);
  return write_png(file, grey.width, grey.height, SPNG_COLOR_TYPE_GRAYSCALE, rows);
}

}  // namespace handcast::renderer
