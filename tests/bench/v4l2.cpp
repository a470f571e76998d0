// SPDX-License-Identifier: Apache-2.0
// What it costs to make a grey image of 720 x 540 px from one of a webcam, by format. No goals:
// the longest of them is far below a period of any webcam.
#include <fmt/format.h>

#include <vector>

#include "renderer/media/jpeg.hpp"
#include "services/camera/v4l2/convert.hpp"
#include "tests/bench/percentiles.hpp"

using namespace handcast;
using namespace handcast::camera::v4l2;

namespace {

constexpr int kWidth = 720, kHeight = 540, kRuns = 1000;

std::vector<std::uint8_t> raw_image(const Layout& layout) {
  std::vector<std::uint8_t> bytes(layout.bytes_per_row * kHeight);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 31 >> 3);
  return bytes;
}

/// A bright disc with some texture before a dark ground, as a hand in infrared light.
std::vector<std::uint8_t> jpeg_image() {
  renderer::Image<std::uint32_t> picture(kWidth, kHeight);
  std::uint32_t noise = 1;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int dx = x - kWidth / 2, dy = y - kHeight / 2;
      noise = noise * 1664525u + 1013904223u;
      const std::uint32_t grey =
          (dx * dx + dy * dy < 150 * 150 ? 150 + x % 32 : 12) + (noise >> 29);
      picture.at(x, y) = 0xff000000u | grey * 0x010101u;
    }
  return renderer::jpeg_of(picture.view());
}

void measure(config::WebcamFormat format) {
  const Layout layout{format, kWidth, kHeight, bytes_per_pixel(format) * kWidth};
  const auto bytes = format == config::WebcamFormat::mjpeg ? jpeg_image() : raw_image(layout);
  std::vector<std::uint8_t> grey(std::size_t{kWidth} * kHeight);
  std::vector<double> times_us;
  for (int run = 0; run < kRuns; ++run) {
    Result<void> done;
    times_us.push_back(bench::timed_us([&] { done = to_grey(layout, bytes, grey); }));
    if (!done) return fmt::print("{}: {}\n", word_of(format), done.error().what);
  }
  fmt::print("{:6} {:8} B  median {:7.1f} us  p99 {:7.1f} us\n", word_of(format), bytes.size(),
             bench::median(times_us), bench::percentile(times_us, 0.99));
}

}  // namespace

int main() {
  for (const auto format : kFormats) measure(format);
  return 0;
}
