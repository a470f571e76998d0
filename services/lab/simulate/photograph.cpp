// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/photograph.hpp"

#include <algorithm>
#include <array>

#include "renderer/draw/cpu/cpu_painter.hpp"

namespace handcast::simulate {
namespace {

using renderer::Rect;
using Rgb = std::array<float, 3>;

constexpr Rgb kSkin{0.86f, 0.70f, 0.60f};  ///< albedo
constexpr Rgb kTable{0.10f, 0.10f, 0.11f};
constexpr float kRoomLight = 0.24f;  ///< relative to the projector's white

std::uint32_t mix(const Rgb& albedo, float shade, std::uint32_t light) {
  std::uint32_t pixel = 0xff000000u;
  for (int channel = 0; channel < 3; ++channel) {
    const auto projected = (light >> 24) ? static_cast<float>(light >> (8 * channel) & 0xff) : 0.0f;
    const auto value =
        albedo[static_cast<std::size_t>(channel)] * (kRoomLight * shade * 255.0f + projected);
    pixel |= static_cast<std::uint32_t>(std::clamp(value, 0.0f, 255.0f)) << (8 * channel);
  }
  return pixel;
}

/// The light of a projector pixel; 0 outside the region of the projection.
std::uint32_t light_at(const msg::Projection& projection, int x, int y) {
  const int column = x - projection.region_x_px, row = y - projection.region_y_px;
  const int width = static_cast<int>(projection.region_width_px),
            height = static_cast<int>(projection.region_height_px);
  if (column < 0 || row < 0 || column >= width || row >= height) return 0;
  return projection.pixels()[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(column)];
}

Rect bounds_of(const std::vector<glm::vec2>& points) {
  glm::vec2 low(1e9f), high(-1e9f);
  for (const auto& point : points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  return {static_cast<int>(low.x) - 1, static_cast<int>(low.y) - 1, static_cast<int>(high.x) + 2,
          static_cast<int>(high.y) + 2};
}

}  // namespace

Photographer::Photographer(const twin::Twin& twin, const calib::Calibration& calibration)
    : twin_(twin),
      painter_(renderer::make_cpu_painter(calibration.projector.width_px,
                                          calibration.projector.height_px)),
      picture_(calibration.projector.width_px, calibration.projector.height_px) {}

void Photographer::pose(const twin::TrueHand& hand, const twin::JointFrames& joints,
                        Surface& surface) const {
  const auto count = hand.mesh.vertex_count();
  surface.position_m.resize(count);
  surface.normal.resize(count);
  surface.position_px.resize(count);
  surface.depth_m.resize(count);
  surface.light.resize(count);
  auto in_camera = joints;
  for (auto& joint : in_camera)
    joint = glm::mat4(twin_.geometry().calibration().camera_from_tracker) * joint;
  twin::pose(hand, in_camera, surface.position_m, surface.normal);
  for (std::size_t v = 0; v < count; ++v) {
    surface.position_px[v] =
        glm::vec2(twin_.geometry().to_projector(glm::dvec3(surface.position_m[v])));
    surface.depth_m[v] = surface.position_m[v].z;
    surface.light[v] = std::clamp(
        -glm::dot(surface.normal[v], glm::normalize(surface.position_m[v])), 0.05f, 1.0f);
  }
}

Rect Photographer::draw_truth(std::int64_t time_ns) {
  std::vector<renderer::DrawnHand> drawn;
  Rect region;
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto joints = twin_.joints(side, time_ns);
    if (!joints) continue;
    const auto& hand = twin_.true_hand(side);
    auto& surface = surfaces_[static_cast<std::size_t>(side)];
    pose(hand, *joints, surface);
    region = region.joined(bounds_of(surface.position_px));
    drawn.push_back(
        {&hand.mesh, renderer::MipView{}, surface.position_px, surface.depth_m, surface.light});
  }
  region = region.within(picture_.width(), picture_.height());
  if (!region.empty()) painter_->draw(drawn, region);
  return region;
}

renderer::View<const std::uint32_t> Photographer::take(const msg::Projection& projection) {
  const auto region = draw_truth(projection.lit_ns);
  const auto shade = painter_->colour();
  const auto surface = painter_->surface();
  for (int y = 0; y < picture_.height(); ++y)
    for (int x = 0; x < picture_.width(); ++x) {
      const bool in_region = x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1;
      const bool skin = in_region && surface.at(x, y) != 0;
      const float lambert = skin ? static_cast<float>(shade.at(x, y) & 0xff) / 255.0f : 1.0f;
      picture_.at(x, y) = mix(skin ? kSkin : kTable, lambert, light_at(projection, x, y));
    }
  return picture_.view();
}

}  // namespace handcast::simulate
