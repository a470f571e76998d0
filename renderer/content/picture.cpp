// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/picture.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/input_file.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/content/jpeg_decoder.hpp"
#include "renderer/content/png_chunks.hpp"

namespace handcast::renderer {
namespace {

constexpr std::uint32_t kOpaque = 0xff000000u;

tl::unexpected<Error> too_large(const std::filesystem::path& file, std::uint32_t width,
                                std::uint32_t height) {
  return fail(Errc::bad_config,
              fmt::format("The picture '{}' is {}x{} px; at most {} px per side are allowed.",
                          file.string(), width, height, kLargestSide));
}

/// libpng's simplified interface; the destructor releases its memory.
struct PngFile {
  png_image png{};
  /// `bytes` must outlive the object.
  explicit PngFile(std::string_view bytes) {
    png.version = PNG_IMAGE_VERSION;
    png_image_begin_read_from_memory(&png, bytes.data(), bytes.size());
  }
  ~PngFile() { png_image_free(&png); }
  bool is_well() const { return !PNG_IMAGE_FAILED(png) && png.width > 0; }
};

/// Decodes `bytes`, the contents of `file`, as `format`. An error if they are no PNG or broken.
template <class Pixel>
Result<Image<Pixel>> decode_png(std::string_view bytes, const std::filesystem::path& file,
                                std::uint32_t format) {
  const auto plain = plain_png(bytes);
  PngFile opened(plain.bytes);
  const auto broken = [&] {
    return fail(Errc::bad_config, fmt::format("'{}' is not a PNG picture.", file.string()));
  };
  if (!opened.is_well()) return broken();
  const auto width = opened.png.width, height = opened.png.height;
  if (std::max(width, height) > kLargestSide) return too_large(file, width, height);
  if (!plain.fault.empty())
    return fail(Errc::bad_config, fmt::format("'{}' {}.", file.string(), plain.fault));
  opened.png.format = format;
  Image<Pixel> image(static_cast<int>(width), static_cast<int>(height));
  const png_color black{};
  if (!png_image_finish_read(&opened.png, &black, image.row(0),
                             static_cast<png_int_32>(width * PNG_IMAGE_PIXEL_CHANNELS(format)),
                             nullptr))
    return broken();
  return image;
}

Result<Texture> read_jpeg(std::string_view bytes, const std::filesystem::path& file) {
  auto texture = decode_jpeg(bytes);
  if (!texture)
    return fail(texture.error().code, fmt::format("'{}' {}.", file.string(), texture.error().what));
  return texture;
}

bool begins_like_png(std::string_view bytes) {
  constexpr std::size_t kSignature = 8;
  return bytes.size() >= kSignature &&
         png_sig_cmp(reinterpret_cast<const png_byte*>(bytes.data()), 0, kSignature) == 0;
}

}  // namespace

Result<Texture> read_picture(const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostPicture);
  if (!bytes) return fail_in("picture", bytes.error());
  auto picture = begins_like_png(*bytes) ? decode_png<std::uint32_t>(*bytes, file, PNG_FORMAT_RGBA)
                                         : read_jpeg(*bytes, file);
  if (!picture) return picture;
  for (int y = 0; y < picture->height(); ++y)
    for (int x = 0; x < picture->width(); ++x) picture->at(x, y) |= kOpaque;
  return picture;
}

Result<Image<std::uint8_t>> read_grey_png(const std::filesystem::path& file) {
  const auto bytes = read_input(file, kMostPicture);
  if (!bytes) return fail_in("picture", bytes.error());
  return decode_png<std::uint8_t>(*bytes, file, PNG_FORMAT_GRAY);
}

/// `pixels`: rows without padding, of one or three bytes per pixel.
static Result<void> write_png(const std::filesystem::path& file, int width_px, int height_px,
                              png_uint_32 format, const std::uint8_t* pixels) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width_px);
  png.height = static_cast<png_uint_32>(height_px);
  png.format = format;
  png.flags = PNG_IMAGE_FLAG_FAST;
  // Not png_image_write_to_file(), which removes the file if it fails, even if it is a device.
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels, 0, nullptr))
    return fail(Errc::unavailable,
                fmt::format("The picture '{}' cannot be made: {}.", file.string(), png.message));
  bytes.resize(size);
  return write_whole(file, bytes, Durable::no);
}

Result<void> write_png(const std::filesystem::path& file, View<const std::uint32_t> picture) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(picture.width) * picture.height * 3);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (const int shift : {0, 8, 16})
        rgb.push_back(static_cast<std::uint8_t>(picture.at(x, y) >> shift));
  return write_png(file, picture.width, picture.height, PNG_FORMAT_RGB, rgb.data());
}

Result<void> write_png(const std::filesystem::path& file, const Image<std::uint8_t>& grey) {
  return write_png(file, grey.width(), grey.height(), PNG_FORMAT_GRAY, grey.pixels().data());
}

}  // namespace handcast::renderer
