// SPDX-License-Identifier: Apache-2.0
// A PNG or JPEG file.
// Limits: 10 s and 1 GB per input.
#include "renderer/media/picture.hpp"

#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  static fuzz::MemoryFile file;
  file.write({data, size});
  if (const auto picture = renderer::read_picture(file.path()))
    fuzz::require(picture->width() > 0 && picture->height() > 0);
  if (const auto camera = renderer::read_camera_picture(file.path()))
    fuzz::require(camera->grey.width() > 0 && camera->grey.height() > 0);
  return 0;
}
