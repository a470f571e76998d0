// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/local_threshold.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/clones.hpp"

namespace handcast::renderer {
namespace {

constexpr int kCell_px = 16;
constexpr int kAtOnce = 64;  ///< cells of a row of pixels that are added up together
constexpr int kRowStep = 8;  ///< one row of eight is measured, and shares its thresholds
/// Position between the dark and the bright mean. Nearer to the middle of the edge than the global
/// threshold can be, which must not lose skin that is darker than the mean.
constexpr float kLocalRimShare = 0.35f;
constexpr float kClear = 8;  ///< least distance from the dark mean: four times the least noise
/// Weight of the means of the whole region, as a share of a full cell: it decides where a cell and
/// its neighbours are wholly dark or wholly bright.
constexpr float kPrior = 0.1f * kCell_px * kCell_px / kRowStep;
/// The threshold of a cell is at most this factor from the global one.
constexpr float kMostFactor = 1.5f;

/// Sums of 16 pixels: all grey values, those above the threshold, and the number of those.
struct Sums {
  std::uint16_t all, bright, bright_count;
};

HANDCAST_CLONES void add_up(const std::uint8_t* pixels, std::uint8_t threshold, int cells,
                            Sums* to) {
  for (int c = 0; c < cells; ++c) {
    std::uint16_t all = 0, bright = 0, count = 0;
    for (int x = 0; x < kCell_px; ++x) {
      const std::uint16_t grey = pixels[c * kCell_px + x];
      const auto lit = static_cast<std::uint16_t>(grey > threshold ? 0xffff : 0);
      all = static_cast<std::uint16_t>(all + grey);
      bright = static_cast<std::uint16_t>(bright + (grey & lit));
      count = static_cast<std::uint16_t>(count + (lit & 1));
    }
    to[c] = {all, bright, count};
  }
}

/// Linear between two values at the centres of adjacent cells.
HANDCAST_CLONES void ramp(const float* centres, int cells, std::uint8_t* out) {
  for (int c = 0; c < cells; ++c)
    for (int x = 0; x < kCell_px; ++x)
      out[c * kCell_px + x] = static_cast<std::uint8_t>(
          centres[c] + (centres[c + 1] - centres[c]) * (static_cast<float>(x) + 0.5f) / kCell_px);
}

}  // namespace

void LocalThreshold::reserve(int width, int height) {
  const auto cells_in = [](int px) {
    return static_cast<std::size_t>(px + kCell_px - 1) / kCell_px;
  };
  const std::size_t columns = cells_in(width), cells = columns * cells_in(height);
  cells_.reserve(cells);
  thresholds_.reserve(cells);
  line_.reserve(columns + 2);
  row_.reserve((columns + 1) * kCell_px);
}

void LocalThreshold::sample(GreyView image, int threshold) {
  cells_.assign(index(0, lines_), {});
  const int whole = std::min(columns_, (image.width - region_.x0) / kCell_px);
  std::array<Sums, kAtOnce> sums;
  for (int y = region_.y0; y < region_.y1; y += kRowStep)
    for (int first = 0; first < whole; first += kAtOnce) {
      const int cells = std::min(kAtOnce, whole - first);
      add_up(image.row(y) + region_.x0 + first * kCell_px, static_cast<std::uint8_t>(threshold),
             cells, sums.data());
      Cell* cell = &cells_[index(first, (y - region_.y0) / kCell_px)];
      for (int c = 0; c < cells; ++c) {
        const auto [all, bright, count] = sums[static_cast<std::size_t>(c)];
        cell[c].dark += static_cast<float>(all - bright);
        cell[c].bright += static_cast<float>(bright);
        cell[c].dark_count += static_cast<float>(kCell_px - count);
        cell[c].bright_count += static_cast<float>(count);
      }
    }
}

/// Adds its neighbours in one direction to each cell: `count` cells, `step` apart.
void LocalThreshold::add_neighbours(Cell* cells, int count, int step) {
  Cell before, here = cells[0];
  for (int i = 0; i < count; ++i) {
    const Cell after = i + 1 < count ? cells[(i + 1) * step] : Cell{};
    cells[i * step] = {before.dark + here.dark + after.dark,
                       before.bright + here.bright + after.bright,
                       before.dark_count + here.dark_count + after.dark_count,
                       before.bright_count + here.bright_count + after.bright_count};
    before = here;
    here = after;
  }
}

void LocalThreshold::measure(GreyView image, const Rect& region, int threshold) {
  region_ = region;
  row_y_ = -1;
  columns_ = (region.width() + kCell_px - 1) / kCell_px;
  lines_ = (region.height() + kCell_px - 1) / kCell_px;
  sample(image, threshold);
  Cell whole;
  for (const Cell& cell : cells_) {
    whole.dark += cell.dark;
    whole.bright += cell.bright;
    whole.dark_count += cell.dark_count;
    whole.bright_count += cell.bright_count;
  }
  const auto global = static_cast<float>(threshold);
  thresholds_.assign(cells_.size(), global);
  if (whole.dark_count == 0 || whole.bright_count == 0) return;
  const float dark_mean = whole.dark / whole.dark_count,
              bright_mean = whole.bright / whole.bright_count;
  for (int line = 0; line < lines_; ++line) add_neighbours(&cells_[index(0, line)], columns_, 1);
  for (int column = 0; column < columns_; ++column)
    add_neighbours(&cells_[index(column, 0)], lines_, columns_);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    const float dark = (cell.dark + kPrior * dark_mean) / (cell.dark_count + kPrior),
                bright = (cell.bright + kPrior * bright_mean) / (cell.bright_count + kPrior);
    const float chosen = std::max(dark + kLocalRimShare * (bright - dark),
                                  std::min(dark + kClear, 0.5f * (dark + bright)));
    thresholds_[i] =
        std::clamp(chosen, global / kMostFactor, std::min(254.0f, global * kMostFactor));
  }
}

/// The threshold at the centre of a column of cells, for the rows from `y`.
float LocalThreshold::at_centre(int column, int y) const {
  const float at = (static_cast<float>(y - region_.y0) + 0.5f * kRowStep) / kCell_px - 0.5f;
  const int above = std::clamp(static_cast<int>(std::floor(at)), 0, lines_ - 1),
            below = std::min(above + 1, lines_ - 1);
  const float share = std::clamp(at - static_cast<float>(above), 0.0f, 1.0f);
  const int held = std::clamp(column, 0, columns_ - 1);
  const float upper = thresholds_[index(held, above)], lower = thresholds_[index(held, below)];
  return upper + share * (lower - upper);
}

/// Fills row_ for the rows from `y`, with half a cell more on either side.
void LocalThreshold::interpolate(int y) {
  line_.resize(static_cast<std::size_t>(columns_) + 2);
  for (int c = 0; c < columns_ + 2; ++c) line_[static_cast<std::size_t>(c)] = at_centre(c - 1, y);
  row_.resize(static_cast<std::size_t>(columns_ + 1) * kCell_px);
  ramp(line_.data(), columns_ + 1, row_.data());
  row_y_ = y;
}

float LocalThreshold::at(int x, int y) const {
  const int first = region_.y0 + (y - region_.y0) / kRowStep * kRowStep;
  const int from_edge = x - region_.x0 + kCell_px / 2, column = from_edge / kCell_px - 1;
  const float left = at_centre(column, first), right = at_centre(column + 1, first);
  return left + (right - left) * (static_cast<float>(from_edge % kCell_px) + 0.5f) / kCell_px;
}

const std::uint8_t* LocalThreshold::row(int y, int x0) {
  const int first = region_.y0 + (y - region_.y0) / kRowStep * kRowStep;
  if (row_y_ != first) interpolate(first);
  return row_.data() + (x0 - region_.x0) + kCell_px / 2;
}

}  // namespace handcast::renderer
