// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/camera_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "renderer/base/clones.hpp"
#include "renderer/base/load_eight.hpp"

namespace handcast::renderer {
namespace {

constexpr int kStep = CameraLookup::kStep;  ///< the side of a block
constexpr int kUnitBits = 6;
constexpr int kUnits = 1 << kUnitBits;  ///< per camera px, in corners
constexpr int kFineBits = 12;           ///< 64 * 8 * 8 units per camera px, between the corners
constexpr int kFine = 1 << kFineBits;
constexpr float kFar_px = 1e5f;  ///< outside any image
static_assert(kFine == kUnits * kStep * kStep);

constexpr int kPartBits = 6, kWhole = 1 << kPartBits;  ///< of a camera px, in weights

/// The mean of the pixels (0, 0), (1, 0) in `upper` and (0, 1), (1, 1) in `lower`, the left one in
/// the lower byte, by the weights of the right and the lower ones.
[[gnu::always_inline]] inline std::int32_t mean_of(std::int32_t upper, std::int32_t lower,
                                                   std::int32_t right, std::int32_t down) {
  const std::int32_t above = (kWhole - right) * (upper & 255) + right * (upper >> 8),
                     below = (kWhole - right) * (lower & 255) + right * (lower >> 8);
  return ((kWhole - down) * above + down * below) >> 2 * kPartBits;
}

/// The part of a camera px in a position.
[[gnu::always_inline]] inline std::int32_t part_of(std::int32_t fine) {
  return fine >> (kFineBits - kPartBits) & (kWhole - 1);
}

/// Interpolates 8 pixels of a row whose neighbours are all inside the mask. `at`, `step`: the
/// position of the first one, and to the next, in fine units.
HANDCAST_CLONES void interpolate_row(const std::uint8_t* mask, std::int32_t stride, glm::ivec2 at,
                                     glm::ivec2 step, std::uint8_t* __restrict out) {
  std::int32_t index[kStep], right[kStep], down[kStep];
  std::uint16_t upper[kStep], lower[kStep];
  for (std::int32_t i = 0; i < kStep; ++i) {
    const std::int32_t x = at.x + i * step.x, y = at.y + i * step.y;
    index[i] = (y >> kFineBits) * stride + (x >> kFineBits);
    right[i] = part_of(x);
    down[i] = part_of(y);
  }
  for (int i = 0; i < kStep; ++i) {
    std::memcpy(&upper[i], mask + index[i], 2);
    std::memcpy(&lower[i], mask + index[i] + stride, 2);
  }
  for (int i = 0; i < kStep; ++i)
    out[i] = static_cast<std::uint8_t>(mean_of(upper[i], lower[i], right[i], down[i]));
}

/// One pixel; 0 outside the mask.
std::uint8_t interpolated(View<const std::uint8_t> mask, glm::ivec2 at) {
  const int x = at.x >> kFineBits, y = at.y >> kFineBits;
  const auto pixel = [&](int column, int row) -> int {
    const bool inside = column >= 0 && row >= 0 && column < mask.width && row < mask.height;
    return inside ? mask.at(column, row) : 0;
  };
  return static_cast<std::uint8_t>(mean_of(pixel(x, y) | pixel(x + 1, y) << 8,
                                           pixel(x, y + 1) | pixel(x + 1, y + 1) << 8,
                                           part_of(at.x), part_of(at.y)));
}

/// True if the pixel and its right and lower neighbours are inside the mask.
bool has_neighbours(View<const std::uint8_t> mask, glm::ivec2 at) {
  const int x = at.x >> kFineBits, y = at.y >> kFineBits;
  return x >= 0 && y >= 0 && x + 1 < mask.width && y + 1 < mask.height;
}

/// The pixel nearest to a position; 0 outside the mask.
std::uint8_t nearest(View<const std::uint8_t> mask, glm::ivec2 at) {
  const int x = (at.x + kFine / 2) >> kFineBits, y = (at.y + kFine / 2) >> kFineBits;
  const bool inside = x >= 0 && y >= 0 && x < mask.width && y < mask.height;
  return inside ? mask.at(x, y) : 0;
}

/// Bounds of what `map` makes of the outline of `region`, sampled at nine points per side and grown
/// by a pixel. Positions beyond +-`limit` and infinite ones are clamped.
template <class Map>
Rect bounds_of(Rect region, double limit, Map map) {
  constexpr int kSteps = 8;
  double x0 = limit, y0 = limit, x1 = -limit, y1 = -limit;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = region.x0 + (region.width() - 1.0) * i / kSteps,
                 y = region.y0 + (region.height() - 1.0) * i / kSteps;
    for (const glm::dvec2 edge : {glm::dvec2(x, region.y0), glm::dvec2(x, region.y1 - 1.0),
                                  glm::dvec2(region.x0, y), glm::dvec2(region.x1 - 1.0, y)}) {
      const glm::dvec2 there = glm::clamp(map(edge), glm::dvec2(-limit), glm::dvec2(limit));
      x0 = std::min(x0, there.x);
      y0 = std::min(y0, there.y);
      x1 = std::max(x1, there.x);
      y1 = std::max(y1, there.y);
    }
  }
  const auto low = [](double v) { return static_cast<int>(std::floor(v)) - 1; };
  const auto high = [](double v) { return static_cast<int>(std::ceil(v)) + 2; };
  return {low(x0), low(y0), high(x1), high(y1)};
}

/// How the image position of what a projector pixel lights changes with its nearness n, 1/m.
/// `on_plane`: its undistorted position for n = 0. With b = H^-1 e, the position for n is exactly
/// on_plane + n (b.z on_plane - b); the lens's distortion is linearised.
glm::vec2 slope_at(const calib::Calibration& calibration, const glm::dvec2& on_plane) {
  constexpr double kSmall = 0.01;  // 1/m
  const auto b = glm::inverse(calibration.projector.from_camera) * calibration.projector.parallax;
  const auto moved = on_plane + kSmall * (b.z * on_plane - glm::dvec2(b));
  const auto slope =
      (calibration.camera.distort(moved) - calibration.camera.distort(on_plane)) / kSmall;
  return glm::vec2(glm::clamp(slope, glm::dvec2(-kFar_px), glm::dvec2(kFar_px)));
}

}  // namespace

CameraLookup::CameraLookup(const calib::Calibration& calibration, bool smooth)
    : width_(calibration.projector.width_px),
      height_(calibration.projector.height_px),
      columns_((width_ + kStep - 1) / kStep + 1),
      rows_((height_ + kStep - 1) / kStep + 1),
      smooth_(smooth),
      calibration_(calibration),
      upper_(static_cast<std::size_t>(columns_)),
      lower_(upper_.size()) {
  table_.reserve(static_cast<std::size_t>(columns_) * rows_);
  aim(calibration.projector);
}

void CameraLookup::aim(const calib::ProjectorModel& projector) {
  calibration_.projector = projector;
  const bool is_coaxial = projector.parallax == glm::dvec3(0);
  const auto to_camera = glm::inverse(projector.from_camera);
  table_.clear();
  slopes_.clear();
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const auto on_plane = calib::mapped(to_camera, {kStep * column, kStep * row});
      const auto camera = calibration_.camera.distort(on_plane);
      table_.push_back(glm::vec2(glm::clamp(camera, glm::dvec2(-kFar_px), glm::dvec2(kFar_px))));
      if (!is_coaxial) slopes_.push_back(slope_at(calibration_, on_plane));
    }
}

/// Image positions, at the exposure, of the block corners in row `row` of the table, from column
/// `first` on.
void CameraLookup::find_corners(int row, int first, std::span<glm::ivec2> corners,
                                const Similarity& then_from_now,
                                std::span<const float> nearness) const {
  std::size_t entry = static_cast<std::size_t>(row) * columns_ + first;
  for (glm::ivec2& corner : corners) {
    glm::vec2 place_px = table_[entry];
    if (!nearness.empty()) place_px += nearness[entry] * slopes_[entry];
    ++entry;
    const glm::vec2 moved_px = glm::clamp(then_from_now(place_px), -kFar_px, kFar_px);
    corner = glm::ivec2(glm::floor(moved_px * static_cast<float>(kUnits) + 0.5f));
  }
}

void CameraLookup::resample(View<const std::uint8_t> mask, Rect region, View<std::uint8_t> out,
                            const Similarity& then_from_now, std::span<const float> nearness) {
  if (slopes_.empty()) nearness = {};
  region = region.within(width_, height_);
  if (region.empty()) return;
  const int first = region.x0 / kStep, last = (region.x1 - 1) / kStep;
  const auto find_lower = [&](int row) {
    const std::span corners(lower_.data(), static_cast<std::size_t>(last - first) + 2);
    find_corners(row, first, corners, then_from_now, nearness);
  };
  find_lower(region.y0 / kStep);
  for (int y = region.y0 / kStep * kStep; y < region.y1; y += kStep) {
    upper_.swap(lower_);
    find_lower(y / kStep + 1);
    for (int column = first; column <= last; ++column) {
      const std::size_t i = static_cast<std::size_t>(column - first);
      const Block block{column * kStep, y, upper_[i], upper_[i + 1], lower_[i], lower_[i + 1]};
      const Rect whole{block.x, y, block.x + kStep, y + kStep};
      const Rect part = whole.overlap(region);
      if (part.width() == kStep && part.height() == kStep && resample_uniform(mask, block, out))
        continue;
      resample_block(mask, block, part, out);
    }
  }
}

/// Fills a block that is all hand or all background, as most blocks are, from a few 8-byte loads.
/// Returns false if the block is mixed, or if the loads cannot decide.
bool CameraLookup::resample_uniform(View<const std::uint8_t> mask, const Block& block,
                                    View<std::uint8_t> out) const {
  const auto [left, right] =
      std::minmax({block.top_left.x, block.top_right.x, block.bottom_left.x, block.bottom_right.x});
  const auto [up, down] =
      std::minmax({block.top_left.y, block.top_right.y, block.bottom_left.y, block.bottom_right.y});
  // The pixels that are read, with 1/8 px of margin at the near corners. The far corners are a
  // pixel beyond the block, which is margin enough for the curvature of the map.
  const int near = smooth_ ? -kUnits / 8 : kUnits * 3 / 8, far = smooth_ ? kUnits : kUnits / 2;
  const int x0 = (left + near) >> kUnitBits, x1 = (right + far) >> kUnitBits;
  const int y0 = (up + near) >> kUnitBits, y1 = (down + far) >> kUnitBits;
  if (x0 < 0 || y0 < 0 || y1 >= mask.height || x1 - x0 >= 8 || x0 + 8 > mask.width) return false;

  std::uint64_t any = 0, all = ~0ull;
  for (int cy = y0; cy <= y1; ++cy) {
    const std::uint64_t eight = load_eight(mask.row(cy) + x0);
    any |= eight;
    all &= eight;
  }
  const std::uint64_t used = ~0ull >> (8 * (7 - (x1 - x0)));
  const bool dark = (any & used) == 0, lit = (all & used) == used;
  if (!dark && !lit) return false;
  const std::uint64_t value = lit ? ~0ull : 0;
  for (int line = block.y; line < block.y + kStep; ++line)
    std::memcpy(out.row(line) + block.x, &value, sizeof value);
  return true;
}

void CameraLookup::resample_block(View<const std::uint8_t> mask, const Block& block, Rect part,
                                  View<std::uint8_t> out) const {
  const bool is_whole = part.width() == kStep;
  for (int y = part.y0; y < part.y1; ++y) {
    const int down = y - block.y;
    const glm::ivec2 left = block.top_left * kStep + (block.bottom_left - block.top_left) * down;
    const glm::ivec2 right =
        block.top_right * kStep + (block.bottom_right - block.top_right) * down;
    const glm::ivec2 step = right - left;
    glm::ivec2 at = left * kStep + step * (part.x0 - block.x);
    std::uint8_t* line = out.row(y);
    if (smooth_ && is_whole && has_neighbours(mask, at) &&
        has_neighbours(mask, at + (kStep - 1) * step)) {
      interpolate_row(mask.data, mask.stride, at, step, line + part.x0);
      continue;
    }
    for (int x = part.x0; x < part.x1; ++x, at += step)
      line[x] = smooth_ ? interpolated(mask, at) : nearest(mask, at);
  }
}

Rect CameraLookup::to_projector(Rect camera_region, float nearness) const {
  if (camera_region.empty()) return {};
  const double depth_m = 1 / (1 / calibration_.projector.plane_m + nearness);
  return bounds_of(camera_region, 1e5, [&](glm::dvec2 image_px) {
    return calibration_.projector.pixel_of(calibration_.camera.undistort(image_px), depth_m);
  });
}

}  // namespace handcast::renderer
