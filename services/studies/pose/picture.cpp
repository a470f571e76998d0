// SPDX-License-Identifier: Apache-2.0
#include "services/studies/pose/picture.hpp"

#include <algorithm>

#include "renderer/content/chart_map.hpp"

namespace handcast::study {
namespace {

constexpr std::uint32_t kSkin = 0xff3a2a1c, kWon = 0xff60c060, kPaper = 0xff20160e,
                        kInk = 0xffffffff;
constexpr float kDrawing_mm = 46, kSmaller = 0.24f, kLine_mm = 1.3f;
constexpr float kRed = 0.5f;  ///< scores up to here are as red as can be

/// From red over yellow to green.
std::uint32_t colour_of(float score) {
  const float good = std::clamp((score - kRed) / (PoseGame::kDone - kRed), 0.f, 1.f);
  const auto red = static_cast<std::uint32_t>(255 * std::min(1.f, 2 - 2 * good)),
             green = static_cast<std::uint32_t>(230 * std::min(1.f, 2 * good));
  return 0xff202000u | green << 8 | red;
}

/// The bone that a joint moves: its own, or that before a tip.
std::uint8_t bone_of(std::size_t joint) {
  for (std::size_t b = 0; b < kBones.size(); ++b)
    if (kBones[b][0] == joint || (kBones[b][1] == joint && b % 3 == 2))
      return static_cast<std::uint8_t>(b + 1);
  return 0;
}

float distance_to(const glm::vec2& at, const glm::vec2& from, const glm::vec2& to) {
  const glm::vec2 way = to - from;
  const float share =
      std::clamp(glm::dot(at - from, way) / std::max(glm::dot(way, way), 1e-6f), 0.f, 1.f);
  return glm::distance(at, from + share * way);
}

}  // namespace

PosePicture::PosePicture(const renderer::HandMesh& mesh, int width_px, int height_px)
    : layout_(mesh, width_px, height_px),
      picture_(width_px, height_px),
      bone_(width_px, height_px) {
  const renderer::ChartMap charts(mesh, width_px, height_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      if (const auto& texel = charts.at(x, y); texel.chart != 0)
        bone_.at(x, y) = bone_of(texel.joint);
}

renderer::View<const std::uint32_t> PosePicture::draw(const HeldPose* wanted,
                                                      const std::optional<PoseScore>& score) {
  for (std::size_t i = 0; i < bone_.pixels().size(); ++i) {
    const auto bone = bone_.pixels()[i];
    picture_.pixels()[i] = !wanted           ? kWon
                           : !score || !bone ? kSkin
                                             : colour_of(score->bones[bone - 1u]);
  }
  if (!wanted) return picture_.view();
  // Seen from the palm, x is mirrored; a finger that is bent is seen shorter.
  for (const auto face : {Face::palm, Face::back}) {
    const auto place = [&](std::size_t joint) {
      const auto& at_mm = wanted->joints_mm[joint];
      const float sign = face == Face::palm ? -1 : 1;
      return glm::vec2(sign * at_mm.x, -at_mm.z) * kSmaller - glm::vec2(0, 18);
    };
    paint(picture_, layout_.palm(face), {}, kDrawing_mm, [&](const glm::vec2& at_mm) {
      float nearest = 1e6f;
      for (const auto& [from, to] : kBones)
        nearest = std::min(nearest, distance_to(at_mm, place(from), place(to)));
      for (const std::size_t knuckle : {2u, 7u, 12u, 17u, 22u})
        nearest = std::min(nearest, distance_to(at_mm, place(1), place(knuckle)));
      return nearest < kLine_mm ? kInk : kPaper;
    });
  }
  return picture_.view();
}

}  // namespace handcast::study
