// SPDX-License-Identifier: Apache-2.0
#include "services/content/surface_map.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/content/chart_raster.hpp"
#include "renderer/draw/cpu/nearest_pixel.hpp"

namespace handcast::content {
namespace {

constexpr int kWrist = 1;

}  // namespace

SurfaceMap::SurfaceMap(const renderer::HandMesh& hand, int width, int height) {
  renderer::Image<SurfaceTexel> all(width, height);
  renderer::Image<std::uint8_t> on(width, height), off(width, height, 1);
  for (const auto& triangle : hand.triangles)
    renderer::for_each_texel(
        hand, triangle, width, height, [&](int x, int y, const std::array<double, 3>& parts) {
          all.at(x, y) = {static_cast<std::uint32_t>(y * width + x),
                          triangle,
                          {static_cast<float>(parts[0]), static_cast<float>(parts[1]),
                           static_cast<float>(parts[2])}};
          on.at(x, y) = 1;
          off.at(x, y) = 0;
        });
  for (std::size_t i = 0; i < on.pixels().size(); ++i) {
    if (on.pixels()[i])
      texels_.push_back(all.pixels()[i]);
    else
      empty_.push_back(static_cast<std::uint32_t>(i));
  }
  renderer::cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(on.view(), off.view(), padding_of(width)))
    copies_.push_back({static_cast<std::uint32_t>(way.y * width + way.x),
                       static_cast<std::uint32_t>((way.y + way.dy) * width + way.x + way.dx)});
}

void SurfaceMap::pad(renderer::Texture& texture) const {
  auto& texels = texture.pixels();
  for (const auto index : empty_) texels[index] = 0;
  for (const auto& [to, from] : copies_) texels[to] = texels[from];
}

std::shared_ptr<const SurfaceMap> surface_map_of(const renderer::HandMesh& hand, int width,
                                                 int height) {
  struct Made {
    std::vector<glm::vec2> uv;
    std::vector<std::array<std::uint16_t, 3>> triangles;
    int width, height;
    std::shared_ptr<const SurfaceMap> map;
  };
  constexpr std::size_t kKept = 4;  // two hands, whole and as large as what moves (HandView)
  static std::vector<Made> all;
  const auto found = std::ranges::find_if(all, [&](const Made& made) {
    return made.width == width && made.height == height && made.uv == hand.uv &&
           made.triangles == hand.triangles;
  });
  if (found != all.end()) return found->map;
  if (all.size() == kKept) all.erase(all.begin());
  all.push_back(
      {hand.uv, hand.triangles, width, height, std::make_shared<SurfaceMap>(hand, width, height)});
  return all.back().map;
}

std::vector<glm::vec3> rest_positions_mm(const renderer::HandMesh& hand) {
  const glm::mat4 wrist_from_model = glm::inverse(hand.rest[kWrist]);
  std::vector<glm::vec3> places;
  for (const auto& position : hand.positions)
    places.push_back(1000.f * glm::vec3(wrist_from_model * glm::vec4(position, 1)));
  return places;
}

std::vector<glm::vec3> rest_normals(const renderer::HandMesh& hand) {
  const glm::mat3 wrist_from_model = glm::transpose(glm::mat3(hand.rest[kWrist]));
  std::vector<glm::vec3> normals;
  for (const auto& normal : hand.normals) normals.push_back(wrist_from_model * normal);
  return normals;
}

std::uint32_t texel_of(const glm::vec4& colour) {
  const float alpha = std::clamp(colour.a, 0.f, 1.f);
  const glm::vec4 values(glm::clamp(glm::vec3(colour), 0.f, 1.f) * alpha, alpha);
  std::uint32_t texel = 0;
  for (int i = 3; i >= 0; --i)
    texel = texel << 8 | static_cast<std::uint32_t>(std::lround(255 * values[i]));
  return texel;
}

}  // namespace handcast::content
