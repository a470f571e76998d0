// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

#include "ipc/msg/largest_images.hpp"
#include "services/tools/preview/scene/scene_maker.hpp"

namespace handcast::preview {
namespace {

using renderer::Image;
using Corners = std::array<glm::vec2, 3>;

constexpr float kLargestTriangle_px = 256;  ///< on a side; more is no part of a hand
constexpr float kFarthest_px = 1e5f;
constexpr std::int64_t kLargestSide_px = 8192;  ///< of a projector

const renderer::HandMesh* mesh_of(const msg::ProjectedHand& hand, const Meshes& meshes) {
  const auto side = static_cast<std::size_t>(hand.side);
  if (side >= meshes.size()) return nullptr;
  const auto& mesh = meshes[side];
  const bool fits = mesh.vertex_count() == hand.vertex_count && hand.vertex_count > 0 &&
                    hand.vertex_count <= hand.landings.size();
  return fits ? &mesh : nullptr;
}

bool is_sound(glm::vec2 point) {
  return std::abs(point.x) < kFarthest_px && std::abs(point.y) < kFarthest_px;
}

bool is_sound(const Corners& triangle) {
  const auto low = glm::min(glm::min(triangle[0], triangle[1]), triangle[2]);
  const auto high = glm::max(glm::max(triangle[0], triangle[1]), triangle[2]);
  return std::ranges::all_of(triangle, [](auto point) { return is_sound(point); }) &&
         high.x - low.x < kLargestTriangle_px && high.y - low.y < kLargestTriangle_px;
}

glm::vec2 landing(const msg::ProjectedHand& hand, std::size_t vertex) {
  return {hand.landings[vertex].x_px, hand.landings[vertex].y_px};
}

float turn(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The columns [first, last] of row `y` that a triangle covers, by the crossings of its edges.
std::pair<int, int> span_in(const Corners& triangle, int y) {
  float left = kFarthest_px, right = -kFarthest_px;
  for (int i = 0; i < 3; ++i) {
    const auto a = triangle[i], b = triangle[(i + 1) % 3];
    const auto row = static_cast<float>(y);
    if (std::min(a.y, b.y) > row || std::max(a.y, b.y) < row || a.y == b.y) continue;
    const float x = a.x + (row - a.y) / (b.y - a.y) * (b.x - a.x);
    left = std::min(left, x);
    right = std::max(right, x);
  }
  return {static_cast<int>(std::ceil(left)), static_cast<int>(std::floor(right))};
}

void fill(Image<std::uint8_t>& covered, const Corners& triangle) {
  const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  const int first = std::max(0, static_cast<int>(std::ceil(low))),
            last = std::min(covered.height() - 1, static_cast<int>(std::floor(high)));
  for (int y = first; y <= last; ++y) {
    const auto [left, right] = span_in(triangle, y);
    const int x0 = std::max(left, 0), x1 = std::min(right, covered.width() - 1);
    if (x0 <= x1) std::fill(covered.row(y) + x0, covered.row(y) + x1 + 1, std::uint8_t{255});
  }
}

template <class Each>
void each_triangle(const msg::ProjectedHand& hand, const renderer::HandMesh& mesh, Each each) {
  for (const auto& triangle : mesh.triangles) {
    const Corners corners{landing(hand, triangle[0]), landing(hand, triangle[1]),
                          landing(hand, triangle[2])};
    if (is_sound(corners)) each(triangle, corners);
  }
}

}  // namespace

bool is_sound(const msg::Projection& projection) {
  const auto limits = [](std::int64_t from, std::int64_t size, std::int64_t all) {
    return from >= 0 && from + size <= all;
  };
  const std::int64_t width = projection.width_px, height = projection.height_px;
  // A slot has room for a region of this size; a calibration allows sides of kLargestSide_px.
  constexpr std::int64_t kLargestRegion =
      msg::kLargestProjectorWidth_px * msg::kLargestProjectorHeight_px;
  // The region lies within the sides before its area is taken, which cannot overflow then.
  return width > 0 && height > 0 && width <= kLargestSide_px && height <= kLargestSide_px &&
         limits(projection.region_x_px, projection.region_width_px, width) &&
         limits(projection.region_y_px, projection.region_height_px, height) &&
         static_cast<std::int64_t>(projection.region_width_px) * projection.region_height_px <=
             kLargestRegion;
}

Image<std::uint8_t> coverage(const msg::Projection& projection, const Meshes& meshes) {
  Image<std::uint8_t> covered(static_cast<int>(projection.width_px),
                              static_cast<int>(projection.height_px));
  for (std::size_t i = 0; i < std::min<std::size_t>(projection.hand_count, projection.hands.size());
       ++i)
    if (const auto* mesh = mesh_of(projection.hands[i], meshes))
      each_triangle(projection.hands[i], *mesh,
                    [&](const auto&, const Corners& corners) { fill(covered, corners); });
  return covered;
}

std::vector<std::pair<glm::vec2, glm::vec2>> visible_edges(const msg::ProjectedHand& hand,
                                                           const Meshes& meshes,
                                                           const FromCamera& from_camera) {
  const auto* mesh = mesh_of(hand, meshes);
  if (!mesh) return {};
  std::vector<glm::vec2> image_px(mesh->vertex_count(), glm::vec2(kFarthest_px));
  for (std::size_t i = 0; i < image_px.size(); ++i) {
    if (!is_sound(landing(hand, i))) continue;
    image_px[i] = from_camera.image_px_of(landing(hand, i)).value_or(image_px[i]);
  }
  std::vector<std::pair<std::uint16_t, std::uint16_t>> edges;
  each_triangle(hand, *mesh, [&](const auto& triangle, const Corners&) {
    // Counter-clockwise seen from outside is a negative turn in an image, where y points down.
    const auto a = image_px[triangle[0]], b = image_px[triangle[1]], c = image_px[triangle[2]];
    if (!is_sound(Corners{a, b, c}) || turn(a, b, c) >= 0) return;
    for (int i = 0; i < 3; ++i) edges.push_back(std::minmax({triangle[i], triangle[(i + 1) % 3]}));
  });
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::pair<glm::vec2, glm::vec2>> lines;
  lines.reserve(edges.size());
  for (const auto& [from, to] : edges) lines.emplace_back(image_px[from], image_px[to]);
  return lines;
}

renderer::Texture whole_light(const msg::Projection& projection, double brightness) {
  renderer::Texture light(static_cast<int>(projection.width_px),
                          static_cast<int>(projection.height_px));
  if (brightness <= 0) return light;
  for (std::uint32_t y = 0; y < projection.region_height_px; ++y)
    std::memcpy(light.row(projection.region_y_px + static_cast<int>(y)) + projection.region_x_px,
                projection.pixels() + static_cast<std::size_t>(y) * projection.region_width_px,
                std::size_t{projection.region_width_px} * sizeof(std::uint32_t));
  if (brightness >= 1) return light;
  config::Projector screen;  // sRGB, whatever the gamma of the projector
  screen.brightness = brightness;
  const auto table = renderer::light_table(screen);
  for (auto& pixel : light.pixels())
    pixel = (pixel & 0xff000000u) | static_cast<std::uint32_t>(table[pixel >> 16 & 255]) << 16 |
            static_cast<std::uint32_t>(table[pixel >> 8 & 255]) << 8 | table[pixel & 255];
  return light;
}

}  // namespace handcast::preview
