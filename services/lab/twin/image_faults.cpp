// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/image_faults.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/surface.hpp"

namespace handcast::twin {
namespace {

constexpr int kBlobs = 12;
constexpr glm::vec3 kHead_m{0.078f, 0.112f, 0.095f};  ///< half the width, height and depth
constexpr float kFarther_m = 0.22f;                   ///< distance of its centre behind the hands

/// Area of each vertex: a third of each adjacent triangle. Vertices behind the wrist have none.
std::vector<double> vertex_areas_m2(const renderer::HandMesh& hand) {
  const auto behind_m = behind_wrist_m(hand);
  std::vector<double> area(hand.positions.size(), 0);
  for (const auto& [a, b, c] : hand.triangles) {
    const auto normal =
        glm::cross(hand.positions[b] - hand.positions[a], hand.positions[c] - hand.positions[a]);
    for (const auto v : {a, b, c})
      if (behind_m[v] <= 0) area[v] += glm::length(normal) / 6;
  }
  return area;
}

/// Distance of each vertex from the nearest centre of a blob. The centres are distributed uniformly
/// over the surface.
std::vector<float> distance_from_blobs_m(const renderer::HandMesh& hand,
                                         const std::vector<double>& area, double whole,
                                         const Random& random) {
  std::vector<float> distance_m(area.size(), 1e9f);
  for (std::uint64_t blob = 0; blob < kBlobs; ++blob) {
    double left = whole * random.uniform(static_cast<std::uint64_t>(hand.side), blob);
    std::size_t middle = 0;
    while (middle + 1 < area.size() && (left -= area[middle]) > 0) ++middle;
    for (std::size_t v = 0; v < area.size(); ++v)
      distance_m[v] =
          std::min(distance_m[v], glm::distance(hand.positions[v], hand.positions[middle]));
  }
  return distance_m;
}

}  // namespace

std::vector<float> draw_holes(const renderer::HandMesh& hand, double share, const Random& random) {
  const auto area = vertex_areas_m2(hand);
  const double whole = std::accumulate(area.begin(), area.end(), 0.0);
  const auto distance_m = distance_from_blobs_m(hand, area, whole, random);
  std::vector<std::size_t> order(area.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distance_m[a] < distance_m[b]; });
  std::vector<float> brightness(area.size(), 1.0f);
  double hidden = 0;
  for (const std::size_t v : order) {
    if (hidden >= share * whole) break;
    hidden += area[v];
    brightness[v] = 0;
  }
  return brightness;
}

Solid make_face(const calib::CameraModel& camera) {
  constexpr double kHands_m = 0.73;
  const double z = kHands_m + kFarther_m;
  const glm::vec3 middle((0.74 * camera.width_px - camera.cx_px) / camera.fx_px * z,
                         (0.36 * camera.height_px - camera.cy_px) / camera.fy_px * z, z);
  return make_ellipsoid(middle, kHead_m);
}

glm::vec3 face_sway_m(std::int64_t time_ns) {
  const auto wave = [&](double hz, double phase) {
    return static_cast<float>(
        std::sin(2 * std::numbers::pi * (hz * ns_to_seconds(time_ns) + phase)));
  };
  return 0.008f * glm::vec3(wave(0.23, 0), wave(0.31, 0.2), wave(0.17, 0.4));
}

void spoil_row(const config::TwinImage& settings, std::span<std::uint8_t> row) {
  constexpr std::uint8_t kDarkGrey = 2;
  const auto hidden = static_cast<std::size_t>(settings.covered * static_cast<double>(row.size()));
  std::fill_n(row.begin(), std::min(hidden, row.size()), kDarkGrey);
  const auto light = static_cast<float>(settings.dark * settings.saturated);
  if (light == 1) return;
  for (auto& pixel : row)
    pixel = static_cast<std::uint8_t>(std::min(255.0f, static_cast<float>(pixel) * light + 0.5f));
}

}  // namespace handcast::twin
