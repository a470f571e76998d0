// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/picture.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/input_file.hpp"
#include "ipc/base/log.hpp"
#include "renderer/media/colour_profile.hpp"
#include "renderer/media/jpeg.hpp"
#include "renderer/media/orientation.hpp"

namespace handcast::renderer {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
/// Memory for the chunks of a file beside its pixels, which may be packed to a thousandth.
constexpr std::size_t kMostChunks = 16 << 20;

std::size_t number_at(std::string_view bytes, std::size_t at, int width, bool big_endian = true) {
  std::size_t value = 0;
  for (int i = 0; i < width; ++i) {
    const auto k = at + static_cast<std::size_t>(big_endian ? i : width - 1 - i);
    value = value << 8 | (k < bytes.size() ? static_cast<std::uint8_t>(bytes[k]) : 0u);
  }
  return value;
}

/// A PNG file without the chunks of text, which the decoder would inflate (thousands of them can
/// take minutes), without Exif, and without a last chunk that is longer than the rest of the file:
/// the decoder asks for the memory of a chunk before it reads it.
struct PngChunks {
  std::string kept;
  std::string exif, cicp;  ///< the contents of eXIf and cICP

  explicit PngChunks(std::string_view bytes) : kept(bytes.substr(0, kPngSignature.size())) {
    constexpr std::size_t kFrame = 12;  // length, type and checksum of a chunk
    bytes.remove_prefix(kept.size());
    while (bytes.size() >= kFrame) {
      const auto length = number_at(bytes, 0, 4);
      const auto type = bytes.substr(4, 4), chunk = bytes.substr(0, kFrame + length);
      if (chunk.size() < kFrame + length) break;
      if (type == "eXIf") exif = bytes.substr(8, length);
      if (type == "cICP") cicp = bytes.substr(8, length);
      if (type != "tEXt" && type != "zTXt" && type != "iTXt" && type != "eXIf") kept += chunk;
      bytes.remove_prefix(chunk.size());
    }
  }
};

/// The contents of the segments of a JPEG file that have a marker and begin with `name`.
std::vector<std::string_view> segments_of(std::string_view jpeg, std::uint8_t marker,
                                          std::string_view name) {
  constexpr std::uint8_t kScan = 0xda;
  std::vector<std::string_view> found;
  for (std::size_t at = 2; at + 4 <= jpeg.size() && number_at(jpeg, at, 1) == 0xff;) {
    const auto type = number_at(jpeg, at + 1, 1), length = number_at(jpeg, at + 2, 2);
    if (type == kScan || length < 2) break;
    const auto content = jpeg.substr(at + 4, length - 2);
    if (type == marker && content.starts_with(name)) found.push_back(content.substr(name.size()));
    at += 2 + length;
  }
  return found;
}

/// The ICC profile of a JPEG file, which its segments hold in numbered parts (ICC.1:2010, B.4).
std::string icc_of_jpeg(std::string_view jpeg) {
  std::map<char, std::string_view> parts;
  for (const auto part : segments_of(jpeg, 0xe2, std::string_view("ICC_PROFILE\0", 12)))
    if (part.size() > 2) parts[part[0]] = part.substr(2);
  std::string icc;
  for (const auto& [number, part] : parts) icc += part;
  return icc;
}

/// The orientation 1..8 in an Exif block, a TIFF header with fields; 1 if it says none.
int orientation_of(std::string_view exif) {
  constexpr std::size_t kOrientation = 0x0112, kField = 12;
  const bool big = exif.starts_with("MM");
  const auto fields = number_at(exif, 4, 4, big);
  for (std::size_t i = 0; i < number_at(exif, fields, 2, big); ++i)
    if (const auto field = fields + 2 + kField * i; number_at(exif, field, 2, big) == kOrientation)
      return std::clamp(static_cast<int>(number_at(exif, field + 8, 2, big)), 1, 8);
  return 1;
}

/// A PNG file whose header has been read.
struct PngFile {
  std::unique_ptr<const PngChunks> chunks;  ///< which the decoder reads
  std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> png;
  spng_ihdr header{};

  bool is_grey() const {
    return header.color_type == SPNG_COLOR_TYPE_GRAYSCALE ||
           header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
  }
  bool is_plain_grey() const {
    spng_trns transparency;
    return header.color_type == SPNG_COLOR_TYPE_GRAYSCALE && header.bit_depth <= 8 &&
           spng_get_trns(png.get(), &transparency) != 0;
  }
};

tl::unexpected<Error> broken(const std::filesystem::path& file) {
  return fail(Errc::bad_config, fmt::format("'{}' is not a PNG picture", file.string()));
}

void say_unknown_colours(const std::filesystem::path& file, std::string_view what,
                         std::string_view why) {
  log::warning(
      "the colours of '{}' are taken for sRGB: its {} cannot be read ({}); convert the "
      "picture to sRGB",
      file.string(), what, why);
}

/// The colours of a picture with an ICC profile; empty if they are those of sRGB.
std::optional<ColourProfile> profile_of(std::string_view icc, bool is_grey,
                                        const std::filesystem::path& file) {
  auto profile = read_icc_profile(icc, is_grey);
  if (profile && !is_srgb(*profile)) return std::move(*profile);
  if (!profile)
    say_unknown_colours(file, fmt::format("colour profile '{}'", name_of_icc_profile(icc)),
                        profile.error().what);
  return std::nullopt;
}

/// The same of a PNG file: by what the standard gives precedence (PNG, third edition, 4.3).
std::optional<ColourProfile> profile_of(const PngFile& opened, const std::filesystem::path& file) {
  constexpr double kScreenGamma = 2.2, kSame = 0.05;
  constexpr std::string_view kSrgb("\1\x0d\0\1", 4);  // ITU-T H.273: primaries, curve, RGB, full
  if (const auto& cicp = opened.chunks->cicp; !cicp.empty()) {
    if (cicp != kSrgb) say_unknown_colours(file, "chunk cICP", "it is not sRGB");
    return std::nullopt;
  }
  auto* png = opened.png.get();
  spng_iccp icc{};
  std::uint8_t intent = 0;
  double gamma = 0;
  if (spng_get_iccp(png, &icc) == 0)
    return profile_of({icc.profile, icc.profile_len}, opened.is_grey(), file);
  if (spng_get_srgb(png, &intent) == 0 || spng_get_gama(png, &gamma) != 0 || gamma <= 0 ||
      std::abs(gamma * kScreenGamma - 1) < kSame)
    return std::nullopt;
  return profile_of_gamma(gamma);
}

Result<PngFile> open_png(std::string_view bytes, const std::filesystem::path& file) {
  PngFile opened{std::make_unique<const PngChunks>(bytes), {spng_ctx_new(0), spng_ctx_free}};
  auto* png = opened.png.get();
  spng_set_chunk_limits(png, kMostPicture, kMostChunks);
  spng_set_png_buffer(png, opened.chunks->kept.data(), opened.chunks->kept.size());
  if (spng_get_ihdr(png, &opened.header) != 0) return broken(file);
  const auto width = opened.header.width, height = opened.header.height;
  if (std::max(width, height) > kLargestSide)
    return fail(Errc::bad_config,
                fmt::format("The picture '{}' is {}x{} px; at most {} px per side are allowed.",
                            file.string(), width, height, kLargestSide));
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

enum class Alpha { over_black, kept };

/// Gives a picture over black its alpha back.
Texture with_alpha(Texture over_black, const std::vector<std::uint32_t>& alphas) {
  for (std::size_t i = 0; i < alphas.size(); ++i)
    over_black.pixels()[i] = (over_black.pixels()[i] & 0xffffff) | alphas[i] << 24;
  return over_black;
}

/// The alphas of a picture, 0..255, if they are wanted.
template <class Pixel, class AlphaOf>
std::vector<std::uint32_t> alphas_of(const Image<Pixel>& picture, Alpha wanted,
                                     const AlphaOf& alpha_of) {
  std::vector<std::uint32_t> alphas;
  if (wanted == Alpha::kept)
    std::ranges::transform(picture.pixels(), std::back_inserter(alphas), alpha_of);
  return alphas;
}

Result<Texture> read_png(std::string_view bytes, const std::filesystem::path& file, Alpha alpha) {
  const auto opened = open_png(bytes, file);
  if (!opened) return tl::make_unexpected(opened.error());
  const int orientation = orientation_of(opened->chunks->exif);
  if (const auto profile = profile_of(*opened, file))
    return decode_as<WidePixel>(SPNG_FMT_RGBA16, *opened, file).map([&](auto&& picture) {
      const auto alphas =
          alphas_of(picture, alpha, [](const WidePixel& pixel) { return (pixel[3] + 128u) / 257; });
      return turned(with_alpha(srgb_over_black(picture, *profile), alphas), orientation);
    });
  return decode_as<std::uint32_t>(SPNG_FMT_RGBA8, *opened, file).map([&](Texture&& picture) {
    const auto alphas = alphas_of(picture, alpha, [](std::uint32_t pixel) { return pixel >> 24; });
    put_over_black(picture);
    picture = with_alpha(std::move(picture), alphas);
    return turned(std::move(picture), orientation);
  });
}

Image<WidePixel> widened(const Texture& picture) {
  Image<WidePixel> wide(picture.width(), picture.height());
  std::ranges::transform(picture.pixels(), wide.pixels().begin(), [](std::uint32_t rgba) {
    const auto value = [&](int k) {
      return static_cast<std::uint16_t>(257 * (rgba >> 8 * k & 255));
    };
    return WidePixel{value(0), value(1), value(2), value(3)};
  });
  return wide;
}

int orientation_of_jpeg(std::string_view jpeg) {
  const auto blocks = segments_of(jpeg, 0xe1, std::string_view("Exif\0\0", 6));
  return blocks.empty() ? 1 : orientation_of(blocks.front());
}

Result<Texture> read_jpeg(std::string_view bytes, const std::filesystem::path& file) {
  auto picture = decode_jpeg(bytes);
  if (!picture)
    return fail(Errc::bad_config, fmt::format("'{}' {}", file.string(), picture.error().what));
  const auto is_grey = [](std::uint32_t rgba) {
    return (rgba & 255) == (rgba >> 8 & 255) && (rgba & 255) == (rgba >> 16 & 255);
  };
  if (const auto icc = icc_of_jpeg(bytes); !icc.empty())
    if (const auto profile = profile_of(icc, std::ranges::all_of(picture->pixels(), is_grey), file))
      picture = srgb_over_black(widened(*picture), *profile);
  return turned(std::move(*picture), orientation_of_jpeg(bytes));
}

std::uint32_t luma_of(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return (299 * red + 587 * green + 114 * blue + 500) / 1000;  // ITU-R BT.601
}

Result<GreyPicture> read_grey_jpeg(std::string_view bytes, const std::filesystem::path& file) {
  const auto picture = decode_jpeg(bytes);
  if (!picture)
    return fail(Errc::bad_config, fmt::format("'{}' {}", file.string(), picture.error().what));
  Image<std::uint8_t> grey(picture->width(), picture->height());
  std::ranges::transform(picture->pixels(), grey.pixels().begin(), [](std::uint32_t rgba) {
    return static_cast<std::uint8_t>(luma_of(rgba & 255, rgba >> 8 & 255, rgba >> 16 & 255));
  });
  return GreyPicture{turned(std::move(grey), orientation_of_jpeg(bytes)), 0};
}

Result<GreyPicture> read_grey_png(std::string_view bytes, const std::filesystem::path& file,
                                  int used_bits) {
  const auto opened = open_png(bytes, file);
  if (!opened) return tl::make_unexpected(opened.error());
  const int orientation = orientation_of(opened->chunks->exif);
  if (opened->is_plain_grey())
    return decode_as<std::uint8_t>(SPNG_FMT_G8, *opened, file).map([&](Image<std::uint8_t>&& grey) {
      return GreyPicture{turned(std::move(grey), orientation), 0};
    });
  const auto wide = decode_as<WidePixel>(SPNG_FMT_RGBA16, *opened, file);
  if (!wide) return tl::make_unexpected(wide.error());
  const bool has_16_bits = opened->header.bit_depth == 16;
  Image<std::uint8_t> grey(wide->width(), wide->height());
  std::uint32_t largest = 0;
  std::ranges::transform(wide->pixels(), grey.pixels().begin(), [&](const WidePixel& pixel) {
    const auto luma = luma_of(pixel[0], pixel[1], pixel[2]);
    const auto value = (luma * pixel[3] + 32'767) / 65'535;
    largest = std::max(largest, value);
    return static_cast<std::uint8_t>(
        std::min(value >> ((has_16_bits ? used_bits : 16) - 8), std::uint32_t{255}));
  });
  return GreyPicture{turned(std::move(grey), orientation), has_16_bits ? largest : 0};
}

}  // namespace

static Result<Texture> read_picture_as(Alpha alpha, const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostPicture);
  if (!bytes) return fail_in("picture", bytes.error());
  return bytes->starts_with(kPngSignature) ? read_png(*bytes, file, alpha)
                                           : read_jpeg(*bytes, file);
}

Result<Texture> read_picture(const std::filesystem::path& file) {
  return read_picture_as(Alpha::over_black, file);
}

Result<Texture> read_premultiplied_picture(const std::filesystem::path& file) {
  return read_picture_as(Alpha::kept, file);
}

Result<GreyPicture> read_camera_picture(const std::filesystem::path& file, int used_bits) {
  const auto bytes = read_input(file, kMostPicture);
  if (!bytes) return fail_in("picture", bytes.error());
  return bytes->starts_with(kPngSignature) ? read_grey_png(*bytes, file, used_bits)
                                           : read_grey_jpeg(*bytes, file);
}

int used_bits_of(std::uint32_t largest) {
  for (const int bits : {8, 10, 12})
    if (largest > 0 && largest < 1u << bits) return bits;
  return 16;
}

}  // namespace handcast::renderer
