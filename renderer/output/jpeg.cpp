// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/jpeg.hpp"

#include <cstdio>
#include <cstdlib>
#include <memory>
// needs cstdio
#include <jpeglib.h>

namespace handcast::renderer {
namespace {

constexpr int kQuality = 95;

struct Free {
  void operator()(unsigned char* bytes) const { std::free(bytes); }
};

}  // namespace

std::vector<std::uint8_t> jpeg_of(View<const std::uint32_t> picture) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);  // only the lack of memory is an error, and ends the process
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(picture.width);
  jpeg.image_height = static_cast<JDIMENSION>(picture.height);
  jpeg.input_components = 4;
  jpeg.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, kQuality, TRUE);
  jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;  // 4:4:4
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < picture.height; ++y) {
    auto* row = reinterpret_cast<JSAMPROW>(const_cast<std::uint32_t*>(picture.row(y)));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const std::unique_ptr<unsigned char, Free> owned(bytes);
  return {bytes, bytes + size};
}

}  // namespace handcast::renderer
