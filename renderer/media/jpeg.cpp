// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/jpeg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
// needs cstdio
#include <jpeglib.h>
// needs jpeglib.h
#include <jerror.h>

#include "renderer/media/picture.hpp"

namespace handcast::renderer {
namespace {

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf way_out;
  const char* trouble;
};

JpegErrors& errors_of(j_common_ptr jpeg) { return *reinterpret_cast<JpegErrors*>(jpeg->err); }

[[noreturn]] void leave(j_common_ptr jpeg) { std::longjmp(errors_of(jpeg).way_out, 1); }
[[noreturn]] void leave_with(j_common_ptr jpeg, const char* trouble) {
  errors_of(jpeg).trouble = trouble;
  leave(jpeg);
}
void say_nothing(j_common_ptr) {}

/// Ends decoding if the file is truncated. libjpeg itself only warns and fills the rest with grey.
void heed_end(j_common_ptr jpeg, int level) {
  if (level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF) leave_with(jpeg, "is truncated");
}

/// Ends decoding if pixels are lost. What webcams send besides does no harm: bytes before a marker,
/// odd headers, no marker at the end (JWRN_JPEG_EOF). If data are missing as well, the decoder
/// comes upon the end too early (JWRN_HIT_MARKER).
void heed_damage(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  switch (jpeg->err->msg_code) {
    case JWRN_HIT_MARKER:
      leave_with(jpeg, "is truncated");
    case JWRN_HUFF_BAD_CODE:
    case JWRN_ARITH_BAD_CODE:
    case JWRN_MUST_RESYNC:
      leave_with(jpeg, "is damaged");
    default:
      break;
  }
}

/// Ends decoding at a scan beyond the last one that a picture needs: a progressive file of a few
/// kilobytes can hold thousands, each of which costs a pass over the whole picture.
void limit_scans(j_common_ptr jpeg) {
  constexpr int kMostScans = 100;
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMostScans)
    leave_with(jpeg, "has more than 100 scans");
}

/// libjpeg's decoder; the destructor releases its memory.
struct Decoder {
  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};
  jpeg_progress_mgr progress{};

  Decoder(const char* trouble, void (*heed)(j_common_ptr, int)) {
    jpeg.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = leave;
    errors.base.output_message = say_nothing;
    errors.base.emit_message = heed;
    errors.trouble = trouble;
    jpeg_create_decompress(&jpeg);
    progress.progress_monitor = limit_scans;
    jpeg.progress = &progress;
  }
  ~Decoder() { jpeg_destroy_decompress(&jpeg); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  bool has_known_colours() const {
    return jpeg.jpeg_color_space == JCS_GRAYSCALE || jpeg.jpeg_color_space == JCS_YCbCr ||
           jpeg.jpeg_color_space == JCS_RGB;
  }
  bool refuse(const char* trouble) {
    errors.trouble = trouble;
    return false;
  }
};

/// libjpeg leaves a broken file by a longjmp to here, so no object with a destructor may be created
/// after setjmp.
bool decode(Decoder& decoder, std::string_view bytes, Texture& texture) {
  auto& jpeg = decoder.jpeg;
  if (setjmp(decoder.errors.way_out) != 0) return false;
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  if (std::max(jpeg.image_width, jpeg.image_height) > kLargestSide) return true;
  if (!decoder.has_known_colours())
    return decoder.refuse(
        "is a JPEG in CMYK or another unsupported colour space; grey, RGB and YCbCr are supported");
  jpeg.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&jpeg);
  texture = Texture(static_cast<int>(jpeg.output_width), static_cast<int>(jpeg.output_height));
  while (jpeg.output_scanline < jpeg.output_height) {
    auto* row = reinterpret_cast<JSAMPLE*>(texture.row(static_cast<int>(jpeg.output_scanline)));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

/// See decode().
bool decode_grey(Decoder& decoder, std::span<const std::uint8_t> bytes, View<std::uint8_t> grey) {
  auto& jpeg = decoder.jpeg;
  if (setjmp(decoder.errors.way_out) != 0) return false;
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  if (jpeg.image_width != static_cast<JDIMENSION>(grey.width) ||
      jpeg.image_height != static_cast<JDIMENSION>(grey.height))
    return decoder.refuse("has another size");
  if (!decoder.has_known_colours()) return decoder.refuse("is in CMYK or unknown colours");
  if (jpeg_has_multiple_scans(&jpeg)) return decoder.refuse("is progressive");
  jpeg.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&jpeg);
  while (jpeg.output_scanline < jpeg.output_height) {
    auto* row = grey.row(static_cast<int>(jpeg.output_scanline));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  return true;
}

}  // namespace

Result<Texture> decode_jpeg(std::string_view bytes) {
  Decoder decoder("is not a PNG or JPEG picture", heed_end);
  Texture texture;
  const bool decoded = decode(decoder, bytes, texture);
  if (decoded && texture.pixels().empty())
    return fail(Errc::bad_config,
                fmt::format("is {}x{} px; at most {} px per side are allowed",
                            decoder.jpeg.image_width, decoder.jpeg.image_height, kLargestSide));
  if (!decoded) return fail(Errc::bad_config, decoder.errors.trouble);
  return texture;
}

Result<void> decode_grey_jpeg(std::span<const std::uint8_t> bytes, View<std::uint8_t> grey) {
  Decoder decoder("is not a JPEG image", heed_damage);
  if (decode_grey(decoder, bytes, grey)) return {};
  return fail(Errc::bad_data, decoder.errors.trouble);
}

namespace {

/// How a picture is written.
struct Writing {
  int components = 4;
  J_COLOR_SPACE space = JCS_EXT_RGBX;
  int quality = 95;
  bool has_all_colour = false;  ///< 4:4:4
};

template <class Pixel>
std::vector<std::uint8_t> write_jpeg(View<const Pixel> picture, const Writing& writing) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);  // only the lack of memory is an error, and ends the process
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(picture.width);
  jpeg.image_height = static_cast<JDIMENSION>(picture.height);
  jpeg.input_components = writing.components;
  jpeg.in_color_space = writing.space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, writing.quality, TRUE);
  if (writing.has_all_colour) jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < picture.height; ++y) {
    auto* row = reinterpret_cast<JSAMPROW>(const_cast<Pixel*>(picture.row(y)));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owned(bytes, std::free);
  return {bytes, bytes + size};
}

}  // namespace

std::vector<std::uint8_t> jpeg_of(View<const std::uint32_t> picture) {
  return write_jpeg(picture, {.has_all_colour = true});
}

std::vector<std::uint8_t> small_jpeg_of(View<const std::uint32_t> picture, int quality) {
  return write_jpeg(picture, {.quality = quality});
}

std::vector<std::uint8_t> small_jpeg_of(View<const std::uint8_t> grey, int quality) {
  return write_jpeg(grey, {.components = 1, .space = JCS_GRAYSCALE, .quality = quality});
}

}  // namespace handcast::renderer
