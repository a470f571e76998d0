// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/reflector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace handcast::calib {
namespace {

constexpr int kLeastGrey = 100;
constexpr int kLeastPixels = 6;
constexpr int kMostAcross_px = 60;
/// Area over that of the circle around the spot: 1 for a disc, .64 for a square.
constexpr double kRound = 0.55;

struct Spot {
  int pixels = 0;
  int x0 = 1 << 30, y0 = 1 << 30, x1 = -1, y1 = -1;  ///< inclusive

  int across_px() const { return std::max(x1 - x0, y1 - y0) + 1; }
  bool is_round() const {
    constexpr double kDisc = 0.785398163;
    const double across = across_px();
    return pixels > kRound * kDisc * across * across;
  }
};

/// The pixels of at least a level, and which of them belong to a spot already.
class Bright {
 public:
  Bright(const GreyView& image, int level)
      : image_(image),
        level_(level),
        taken_(static_cast<std::size_t>(image.width_px) *
               static_cast<std::size_t>(image.height_px)) {}

  /// The spots of at least kLeastPixels, at most `most`.
  std::vector<Spot> spots(std::size_t most) {
    std::vector<Spot> spots;
    for (int y = 0; y < image_.height_px; ++y)
      for (int x = 0; x < image_.width_px; ++x) {
        if (!is_free(x, y)) continue;
        if (const Spot spot = fill(x, y); spot.pixels >= kLeastPixels) spots.push_back(spot);
        if (spots.size() == most) return spots;
      }
    return spots;
  }

 private:
  bool is_free(int x, int y) const {
    return x >= 0 && y >= 0 && x < image_.width_px && y < image_.height_px &&
           image_.pixels[y * image_.stride + x] >= level_ && !taken_[index(x, y)];
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width_px) +
           static_cast<std::size_t>(x);
  }
  Spot fill(int x, int y) {
    Spot spot;
    std::vector<std::pair<int, int>> open{{x, y}};
    taken_[index(x, y)] = true;
    while (!open.empty()) {
      const auto [at_x, at_y] = open.back();
      open.pop_back();
      ++spot.pixels;
      spot.x0 = std::min(spot.x0, at_x);
      spot.x1 = std::max(spot.x1, at_x);
      spot.y0 = std::min(spot.y0, at_y);
      spot.y1 = std::max(spot.y1, at_y);
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        if (is_free(at_x + dx, at_y + dy)) {
          taken_[index(at_x + dx, at_y + dy)] = true;
          open.emplace_back(at_x + dx, at_y + dy);
        }
    }
    return spot;
  }

  GreyView image_;
  int level_;
  std::vector<bool> taken_;
};

int brightest(const GreyView& image) {
  int most = 0;
  for (int y = 0; y < image.height_px; ++y) {
    const auto* row = image.pixels + y * image.stride;
    most = std::max<int>(most, *std::max_element(row, row + image.width_px));
  }
  return most;
}

/// The mean of the pixels of a spot and beside it, weighted by what is above `level`.
glm::dvec2 centre_of(const GreyView& image, const Spot& spot, int level) {
  glm::dvec2 sum(0);
  double weights = 0;
  for (int y = std::max(spot.y0 - 1, 0); y <= std::min(spot.y1 + 1, image.height_px - 1); ++y)
    for (int x = std::max(spot.x0 - 1, 0); x <= std::min(spot.x1 + 1, image.width_px - 1); ++x) {
      const double weight = std::max(image.pixels[y * image.stride + x] - level, 0);
      sum += weight * glm::dvec2(x, y);
      weights += weight;
    }
  return sum / weights;
}

}  // namespace

Reflector find_reflector(const GreyView& image) {
  Reflector found;
  if (image.width_px <= 0 || image.height_px <= 0) return found;
  const int most = brightest(image);
  if (most < kLeastGrey) return found;
  constexpr int kLevel_percent = 80;
  const int level = most * kLevel_percent / 100;
  const auto spots = Bright(image, level).spots(2);
  if (spots.empty()) return found;
  const bool all_small = std::ranges::all_of(
      spots, [](const Spot& spot) { return spot.across_px() <= kMostAcross_px; });
  if (!all_small || !spots.front().is_round()) {
    found.fault = ReflectorFault::merged;
    return found;
  }
  if (spots.size() > 1) {
    found.fault = ReflectorFault::several;
    return found;
  }
  found.fault = ReflectorFault::none;
  found.image_px = centre_of(image, spots.front(), level - 1);
  found.diameter_px = 2 * std::sqrt(spots.front().pixels / 3.14159265);
  return found;
}

std::string_view advice_on(ReflectorFault fault) {
  switch (fault) {
    case ReflectorFault::none:
      return "";
    case ReflectorFault::dark:
      return "No reflector is seen: hold the index finger into the image, or expose longer.";
    case ReflectorFault::several:
      return "There are several bright spots: cover or take away all but the reflector.";
    case ReflectorFault::merged:
      return "The hand is as bright as the reflector: expose for a shorter time, so that only the "
             "reflector is white.";
  }
  return "";
}

}  // namespace handcast::calib
