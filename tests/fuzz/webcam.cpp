// SPDX-License-Identifier: Apache-2.0
// An image of a webcam: format, width - 1, height - 1, bytes of padding per row, then the bytes
// that the driver delivered. Limits: 10 s and 1 GB per input.
#include <vector>

#include "services/camera/v4l2/convert.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace handcast;
  using namespace handcast::camera::v4l2;
  fuzz::Reader reader({data, size});
  Layout layout;
  layout.format = kFormats[reader.number<std::uint8_t>() % kFormats.size()];
  layout.width_px = reader.number<std::uint8_t>() + 1;
  layout.height_px = reader.number<std::uint8_t>() + 1;
  const auto padding = reader.number<std::uint8_t>();
  layout.bytes_per_row = bytes_per_pixel(layout.format) * layout.width_px + padding;
  const auto rest = reader.take(size);
  // Each in memory of its own, so that a byte too many is found.
  const std::vector<std::uint8_t> bytes(rest.begin(), rest.end());
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(layout.width_px) * layout.height_px);
  const auto converted = to_grey(layout, bytes, grey);
  if (layout.format != config::WebcamFormat::mjpeg)
    fuzz::require(converted.has_value() == (bytes.size() >= least_bytes(layout)));
  return 0;
}
