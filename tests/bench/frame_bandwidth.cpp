// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/frame_bandwidth.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "renderer/draw/cpu/frame_buffer.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

constexpr double kTexels = 4 * 4;  ///< bytes of the four texels of a filtered pixel
/// Bytes of a pixel in the planes of cpu::FrameBuffer: colour, place, surface, shade.
constexpr double kDrawn = 4 + 8 + sizeof(renderer::SurfaceId) + 2;

/// Each drawn pixel: its texels and its planes. What is kept for a band stays in the first cache.
double bytes_of_draw(const FrameTimes& times) { return times.lit_px * (kTexels + kDrawn); }

/// Each pixel of the region: mask and surface are read, the planes of lit and unlit pixels are
/// written and read. Each filled pixel: the place, surface and shade of two others, its texels, its
/// colour, and a patch of 20 bytes and its place among 16, 32 bytes, written and read.
double bytes_of_fill(const FrameTimes& times) {
  return times.region_px * (1. + sizeof(renderer::SurfaceId) + 2 + 2) +
         times.filled_px * (2 * (kDrawn - 4) + kTexels + 4 + 2 * (20 + 32));
}

/// Bytes read and written in a µs by a copy of `bytes` / 2, the median of 200.
double copy_speed(double bytes) {
  std::vector<char> from(static_cast<std::size_t>(bytes / 2), 1), to(from.size());
  std::vector<double> speeds;
  for (int i = 0; i < 200; ++i) {
    const double us = timed_us([&] { std::memcpy(to.data(), from.data(), from.size()); });
    from[static_cast<std::size_t>(i)] = to.back();
    speeds.push_back(bytes / us);
  }
  return median(speeds);
}

}  // namespace

std::vector<std::pair<std::string, double>> print_bandwidth(const FrameTimes& times) {
  if (!times.error.empty() || times.frame_us.empty()) return {};
  const std::array passes{std::pair{"draw", bytes_of_draw(times)},
                          std::pair{"fill", bytes_of_fill(times)}};
  fmt::print(
      "\nthe limit of the memory, one open hand, region {} px\n{:<10} {:>10} {:>10} {:>12} "
      "{:>12} {:>8}\n",
      times.region_px, "", "MB", "copy GB/s", "at least µs", "measured µs", "times");
  std::vector<std::pair<std::string, double>> ratios;
  for (const auto& [pass, bytes] : passes) {
    const double speed = copy_speed(bytes), measured_us = median(times.stage_us.at(pass));
    fmt::print("{:<10} {:10.2f} {:10.1f} {:12.0f} {:12.0f} {:8.1f}\n", pass, bytes / 1e6,
               speed / 1e3, bytes / speed, measured_us, measured_us * speed / bytes);
    ratios.emplace_back(pass, measured_us * speed / bytes);
  }
  return ratios;
}

}  // namespace handcast::bench
