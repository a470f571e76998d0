// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/handcast_network.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "renderer/base/clones.hpp"
#include "services/landmarks/crop/histogram.hpp"

namespace handcast::landmarks::handcast_network {
namespace {

constexpr float kRoom = 1.3f;  ///< the region's side, as a multiple of the landmarks' larger extent
constexpr float kLeastPalms = 1.45f;  ///< its least side, in palm lengths
constexpr float kLeastBright = 12;    ///< darker crops are treated as if they were this bright
constexpr float kMapSigma = 1.2f;     ///< of the Gaussian in a tracker map, in cells
constexpr float kLeastBell = 1e-15f;  ///< smaller values are 0
constexpr std::size_t kHeatSize = kHeatCells * kHeatCells;

glm::vec2 mirrored(glm::vec2 place) { return {1 - place.x, place.y}; }

using Bell = std::array<float, kMapCells>;

/// A Gaussian over the cells of one axis. Its ends are 0: products of smaller values would be
/// denormal numbers, which make processors slow.
Bell bell_at(float place) {
  Bell bell;
  for (int i = 0; i < kMapCells; ++i) {
    const float cells = (static_cast<float>(i) + 0.5f - place * kMapCells) / kMapSigma;
    const float value = exponential(-0.5f * cells * cells);
    bell[i] = value > kLeastBell ? value : 0;
  }
  return bell;
}

HANDCAST_CLONES void write_maps(const Places& tracker, float* __restrict to) {
  for (const glm::vec2 place : tracker) {
    const Bell across = bell_at(place.x), down = bell_at(place.y);
    for (const float row : down)
      for (const float column : across) *to++ = row * column;
  }
}

/// From a grey value to the network's input.
struct Shown {
  float scale;

  float operator()(std::uint8_t pixel) const {
    return std::min(static_cast<float>(pixel) * scale, kMostShown) - kShownShift;
  }
};

Shown shown_of(std::span<const std::uint8_t> pixels) {
  const Histogram histogram = histogram_of(pixels);
  std::size_t above = 0;
  int bright = 255;
  while (bright > 0 && (above += histogram[bright]) * 50 < pixels.size()) --bright;
  return {1 / std::max(static_cast<float>(bright), kLeastBright)};
}

HANDCAST_CLONES void show_row(const std::uint8_t* __restrict from, Shown shown, bool mirror,
                              float* __restrict to) {
  if (mirror)
    for (int x = 0; x < kSide_px; ++x) to[x] = shown(from[kSide_px - 1 - x]);
  else
    for (int x = 0; x < kSide_px; ++x) to[x] = shown(from[x]);
}

/// Sums over the cells of a heat map, each weighted by the exponential of its score (softmax).
struct Weighed {
  float weight = 0, column = 0, row = 0, log_sigma = 0;
};

using Row = std::array<float, kHeatCells>;

float sum_of(const Row& row) { return std::accumulate(row.begin(), row.end(), 0.0f); }

HANDCAST_CLONES void weigh(const float* scores, const float* log_sigmas, Weighed& result) {
  Row most, weight{}, by_row{}, log_sigma{};
  std::copy_n(scores, kHeatCells, most.begin());
  for (int row = 1; row < kHeatCells; ++row)
    for (int x = 0; x < kHeatCells; ++x) most[x] = std::max(most[x], scores[row * kHeatCells + x]);
  const float highest = *std::ranges::max_element(most);
  for (int row = 0; row < kHeatCells; ++row)
    for (int x = 0; x < kHeatCells; ++x) {
      const float w = exponential(scores[row * kHeatCells + x] - highest);
      weight[x] += w;
      by_row[x] += w * static_cast<float>(row);
      log_sigma[x] += w * log_sigmas[row * kHeatCells + x];
    }
  result = {sum_of(weight), 0, sum_of(by_row), sum_of(log_sigma)};
  for (int x = 0; x < kHeatCells; ++x) result.column += weight[x] * static_cast<float>(x);
}

}  // namespace

Region region_around(const Points& points_px) {
  const glm::vec2 up = points_px[9] - points_px[0];
  const float angle_rad = std::atan2(up.x, -up.y);
  glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const glm::vec2 point : points_px) {
    const glm::vec2 upright = turned(point, -angle_rad);
    low = glm::min(low, upright);
    high = glm::max(high, upright);
  }
  const glm::vec2 extent = high - low;
  const float size_px =
      std::max(kRoom * std::max(extent.x, extent.y), kLeastPalms * glm::length(up));
  return {turned(0.5f * (low + high), angle_rad), size_px, angle_rad};
}

Places to_places(const Region& region, msg::Side side, const Points& points_px) {
  Places places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = region.to_place(points_px[i]) + 0.5f;
    if (side == msg::Side::left) places[i] = mirrored(places[i]);
  }
  return places;
}

Points to_image(const Region& region, msg::Side side, const Places& places) {
  Points points_px;
  for (std::size_t i = 0; i < places.size(); ++i)
    points_px[i] =
        region.to_image((side == msg::Side::left ? mirrored(places[i]) : places[i]) - 0.5f);
  return points_px;
}

std::array<float, 256> shown_values(std::span<const std::uint8_t> pixels) {
  const Shown shown = shown_of(pixels);
  std::array<float, 256> values;
  for (int i = 0; i < 256; ++i) values[i] = shown(static_cast<std::uint8_t>(i));
  return values;
}

void write_image(std::span<const std::uint8_t> pixels, msg::Side side, std::span<float> input) {
  const Shown shown = shown_of(pixels);
  for (int y = 0; y < kSide_px; ++y)
    show_row(pixels.data() + y * kSide_px, shown, side == msg::Side::left,
             input.data() + y * kSide_px);
}

void write_tracker(const std::optional<Places>& tracker, std::span<float> input) {
  if (tracker)
    write_maps(*tracker, input.data());
  else
    std::ranges::fill(input, 0.0f);
}

Answer read_answer(std::span<const float> output) {
  const auto map = [&](std::size_t i) { return output.subspan(i * kHeatSize, kHeatSize); };
  Answer answer;
  for (std::size_t i = 0; i < answer.places.size(); ++i) {
    Weighed sums;
    weigh(map(i).data(), map(msg::kLandmarks + i).data(), sums);
    answer.places[i] =
        (glm::vec2(sums.column, sums.row) / sums.weight + 0.5f) / static_cast<float>(kHeatCells);
    answer.sigma[i] = std::exp(std::clamp(sums.log_sigma / sums.weight, -12.0f, 3.0f));
  }
  const auto logits = map(2 * msg::kLandmarks);
  const float logit =
      std::accumulate(logits.begin(), logits.end(), 0.0f) / static_cast<float>(kHeatSize);
  answer.presence = 1 / (1 + std::exp(-logit));
  return answer;
}

}  // namespace handcast::landmarks::handcast_network
