// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/flat_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/base/clones.hpp"

namespace handcast::twin {

Result<void> check(const FlatPicture& picture) {
  const bool has_pixels = picture.width_px > 0 && picture.height_px > 0 &&
                          picture.pixels.size() == static_cast<std::size_t>(picture.width_px) *
                                                       static_cast<std::size_t>(picture.height_px);
  if (!has_pixels)
    return fail(Errc::bad_data,
                fmt::format("twin: the picture of the board should have {} x {} pixels, but has {}",
                            picture.width_px, picture.height_px, picture.pixels.size()));
  const bool has_place = picture.metres_per_px > 0 && std::isfinite(picture.metres_per_px) &&
                         std::isfinite(picture.origin_px.x) && std::isfinite(picture.origin_px.y);
  if (!has_place)
    return fail(Errc::bad_data,
                fmt::format("twin: the picture of the board is of no use, with {} m per pixel and "
                            "its origin at ({}, {})",
                            picture.metres_per_px, picture.origin_px.x, picture.origin_px.y));
  return {};
}

namespace {

HANDCAST_CLONES
void pack_row(const std::uint8_t* row, const std::uint8_t* below, std::uint32_t* quads, int width) {
  for (int x = 0; x + 1 < width; ++x)
    quads[x] = row[x] | static_cast<std::uint32_t>(row[x + 1]) << 8 |
               static_cast<std::uint32_t>(below[x]) << 16 |
               static_cast<std::uint32_t>(below[x + 1]) << 24;
  const int last = width - 1;
  quads[last] = row[last] * 0x101u | below[last] * 0x1010000u;
}

struct Quads {
  const std::uint32_t* data;
  int width, height;
};

HANDCAST_CLONES
void sample_row(const Quads quads, const float* map, const float* ray_x, const float* ray_y,
                int count, float* __restrict grey, float* __restrict inside) {
  const float m0 = map[0], m1 = map[1], m2 = map[2], m3 = map[3], m4 = map[4], m5 = map[5],
              m6 = map[6], m7 = map[7], m8 = map[8];
  const auto right = static_cast<float>(quads.width - 1),
             bottom = static_cast<float>(quads.height - 1);
  for (int i = 0; i < count; ++i) {
    const float scale = 1 / (m2 * ray_x[i] + m5 * ray_y[i] + m8);
    const float u = (m0 * ray_x[i] + m3 * ray_y[i] + m6) * scale,
                v = (m1 * ray_x[i] + m4 * ray_y[i] + m7) * scale;
    const bool in = (u >= -0.5f) & (v >= -0.5f) & (u < right + 0.5f) & (v < bottom + 0.5f);
    // A place that is no number counts as the first pixel.
    const float cu = u > 0 ? (u < right ? u : right) : 0,
                cv = v > 0 ? (v < bottom ? v : bottom) : 0;
    const int left = static_cast<int>(cu), top = static_cast<int>(cv);
    const std::uint32_t quad = quads.data[top * quads.width + left];
    const float fu = cu - static_cast<float>(left), fv = cv - static_cast<float>(top);
    const auto a = static_cast<float>(static_cast<int>(quad & 255)),
               b = static_cast<float>(static_cast<int>(quad >> 8 & 255)),
               c = static_cast<float>(static_cast<int>(quad >> 16 & 255)),
               d = static_cast<float>(static_cast<int>(quad >> 24));
    const float upper = a + fu * (b - a), lower = c + fu * (d - c);
    inside[i] = in ? 1.0f : 0.0f;
    grey[i] = (upper + fv * (lower - upper)) * (in ? 1 / 255.0f : 0.0f);
  }
}

/// A picture of odd size repeats its last pixels.
renderer::Image<std::uint8_t> halved(renderer::GreyView picture) {
  renderer::Image<std::uint8_t> half((picture.width + 1) / 2, (picture.height + 1) / 2);
  for (int y = 0; y < half.height(); ++y) {
    const std::uint8_t* row = picture.row(2 * y);
    const std::uint8_t* below = picture.row(std::min(2 * y + 1, picture.height - 1));
    for (int x = 0; x < half.width(); ++x) {
      const int left = 2 * x, right = std::min(2 * x + 1, picture.width - 1);
      half.at(x, y) =
          static_cast<std::uint8_t>((row[left] + row[right] + below[left] + below[right] + 2) / 4);
    }
  }
  return half;
}

}  // namespace

void QuadImage::assign(renderer::GreyView grey) {
  if (quads_.width() != grey.width || quads_.height() != grey.height)
    quads_ = renderer::Image<std::uint32_t>(grey.width, grey.height);
  for (int y = 0; y < grey.height; ++y)
    pack_row(grey.row(y), grey.row(y + 1 < grey.height ? y + 1 : y), quads_.row(y), grey.width);
}

void QuadImage::sample(const glm::mat3& picture_from_ray, const float* x, const float* y, int count,
                       float* grey, float* inside) const {
  sample_row({quads_.pixels().data(), width(), height()}, &picture_from_ray[0][0], x, y, count,
             grey, inside);
}

std::vector<QuadImage> make_levels(renderer::GreyView picture) {
  std::vector<QuadImage> levels(1);
  levels[0].assign(picture);
  renderer::Image<std::uint8_t> smaller;
  while (picture.width > 1 && picture.height > 1) {
    smaller = halved(picture);
    picture = std::as_const(smaller).view();
    levels.emplace_back().assign(picture);
  }
  return levels;
}

}  // namespace handcast::twin
