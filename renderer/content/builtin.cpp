// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/builtin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "renderer/content/chart_map.hpp"
#include "renderer/content/lettering.hpp"

namespace handcast::renderer {
namespace {

constexpr int kWidth = 1024, kHeight = 640;

using Colour = glm::vec3;  ///< red, green, blue, 0..255
constexpr Colour kPaper{252, 248, 240}, kInk{24, 28, 44};

std::uint32_t packed(Colour colour) {
  const auto byte = [](float value) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.f, 255.f)));
  };
  return 0xff000000u | byte(colour.b) << 16 | byte(colour.g) << 8 | byte(colour.r);
}

/// Coverage of a line of half width `half` at a distance `away` from its middle, with an edge of
/// width `soft`.
float line(float away, float half, float soft) {
  return std::clamp((half + soft - away) / soft, 0.f, 1.f);
}

/// The finger of a joint, 0 thumb to 4 little finger; -1 for palm, wrist and metacarpals.
int finger_of(int joint) {
  if (joint < 2) return -1;                   // palm, wrist
  if (joint < 6) return joint == 2 ? -1 : 0;  // thumb: metacarpal, proximal, distal, tip
  return (joint - 6) % 5 == 0 ? -1 : 1 + (joint - 6) / 5;
}

/// The number of a joint's bone in its finger, 0 next to the palm.
int bone_of(int joint) { return joint < 6 ? joint - 3 : (joint - 7) % 5; }

/// Numbered fields on the back and the palm, bands on the fingers, and a fine grid.
class Atlas {
 public:
  explicit Atlas(const ChartMap& charts) : charts_(charts) {}

  Colour operator()(const ChartTexel& texel) {
    const glm::vec2 place{texel.rest_mm.x, texel.rest_mm.z};
    const glm::ivec2 field(glm::floor(place / kFieldMm));
    const glm::vec2 from_centre = place - (glm::vec2(field) + 0.5f) * kFieldMm;
    const float facing = charts_.facing(texel.chart);
    Colour colour = ground(texel, field, facing);
    const glm::vec2 fine = glm::abs(place / kFineMm - glm::round(place / kFineMm)) * kFineMm;
    colour = glm::mix(colour, kPaper, 0.45f * line(std::min(fine.x, fine.y), 0.15f, 0.25f));
    const glm::vec2 to_border = kFieldMm / 2 - glm::abs(from_centre);
    colour = glm::mix(colour, kInk, 0.8f * line(std::min(to_border.x, to_border.y), 0.3f, 0.3f));
    // As seen when looking at this side with the fingers up.
    const glm::vec2 right_up{facing * from_centre.x, -from_centre.y};
    return glm::mix(colour, kInk, coverage(label(texel, field, facing), right_up));
  }

 private:
  static constexpr float kFieldMm = 16, kFineMm = 4, kLetterMm = 5.5f;
  static constexpr int kLetterPx = 56;

  static Colour ground(const ChartTexel& texel, glm::ivec2 field, float facing) {
    static constexpr std::array<Colour, 5> kFingers{
        Colour{236, 94, 80}, {244, 168, 54}, {112, 190, 88}, {64, 156, 220}, {158, 108, 214}};
    const int finger = finger_of(texel.joint);
    if (finger >= 0) return kFingers[finger] * (bone_of(texel.joint) % 2 == 0 ? 1.f : 0.72f);
    const bool dark = (field.x + field.y) % 2 != 0;
    if (facing > 0) return dark ? Colour{120, 196, 190} : Colour{170, 224, 214};
    return dark ? Colour{238, 176, 140} : Colour{250, 212, 180};
  }

  /// The letter of the column (A, B, ... on the back, P, Q, ... on the palm) and the number of the
  /// row from the forearm up. On fingers: 1 (thumb) to 5.
  static std::string label(const ChartTexel& texel, glm::ivec2 field, float facing) {
    const int finger = finger_of(texel.joint);
    if (finger >= 0) return std::to_string(finger + 1);
    const auto column = static_cast<char>((facing > 0 ? 'A' : 'P') + std::clamp(field.x + 4, 0, 9));
    return fmt::format("{}{}", column, std::clamp(6 - field.y, 0, 99));
  }

  /// Coverage by the letters of `text` at a point, in mm from the middle of the field.
  float coverage(const std::string& text, glm::vec2 right_up_mm) {
    auto known = letters_.find(text);
    if (known == letters_.end()) known = letters_.emplace(text, lettering(text, kLetterPx)).first;
    const Image<std::uint8_t>& letters = known->second;
    const float px_per_mm = kLetterPx / kLetterMm;
    const int x = static_cast<int>(std::floor(letters.width() / 2.f + right_up_mm.x * px_per_mm));
    const int y = static_cast<int>(std::floor(letters.height() / 2.f - right_up_mm.y * px_per_mm));
    if (x < 0 || y < 0 || x >= letters.width() || y >= letters.height()) return 0;
    return letters.at(x, y) / 255.f;
  }

  const ChartMap& charts_;
  std::map<std::string, Image<std::uint8_t>> letters_;
};

/// Bones and joints where they lie under the skin, seen from the back or from the palm.
class Skeleton {
 public:
  explicit Skeleton(const HandMesh& hand) {
    for (int joint = 0; joint < kJoints; ++joint)
      joints_mm_[joint] = 1000.f * glm::vec2(hand.rest[joint][3].x, hand.rest[joint][3].z);
  }

  Colour operator()(const ChartTexel& texel) const {
    const glm::vec2 place{texel.rest_mm.x, texel.rest_mm.z};
    float to_bone = 1e9f, to_joint = 1e9f;
    for (int joint = 1; joint < kJoints; ++joint) {
      to_joint = std::min(to_joint, glm::distance(place, joints_mm_[joint]));
      if (kJointParent[joint] >= 1)
        to_bone = std::min(to_bone, distance_to_segment(place, joints_mm_[joint],
                                                        joints_mm_[kJointParent[joint]]));
    }
    Colour colour{22, 36, 78};
    colour = glm::mix(colour, kPaper, line(to_bone, 1.3f, 0.4f));
    return glm::mix(colour, Colour{255, 140, 40}, line(to_joint, 2.8f, 0.4f));
  }

 private:
  static float distance_to_segment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
    const glm::vec2 along = b - a;
    const float length2 = std::max(glm::dot(along, along), 1e-6f);
    return glm::distance(p, a + along * std::clamp(glm::dot(p - a, along) / length2, 0.f, 1.f));
  }

  std::array<glm::vec2, kJoints> joints_mm_;
};

using PaintTexel = std::function<Colour(const ChartTexel&, int x, int y)>;

/// Paints all texels, pads the charts outwards, and draws their outlines last, so that the fill
/// finds the content outside a chart and not its outline.
Texture paint(const ChartMap& charts, const PaintTexel& colour_of) {
  Image<Colour> colours(kWidth, kHeight, kInk);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (const ChartTexel& texel = charts.at(x, y); texel.chart != 0)
        colours.at(x, y) = colour_of(texel, x, y);
    }
  }
  charts.pad(colours);
  Texture texture(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const ChartTexel& texel = charts.at(x, y);
      const float outline = texel.chart != 0 ? line(texel.edge_px, 2, 1) : 0;
      texture.at(x, y) = packed(glm::mix(colours.at(x, y), kPaper, outline));
    }
  }
  return texture;
}

/// Squares of 32 texels, which show how the texture layout distorts lengths.
Colour checker(const ChartTexel& texel, int x, int y) {
  const Colour light = texel.chart % 2 == 1 ? Colour{250, 240, 210} : Colour{214, 236, 250};
  return (x / 32 + y / 32) % 2 == 0 ? light : Colour{32, 60, 96};
}

}  // namespace

std::optional<Texture> paint_builtin(std::string_view name, const HandMesh& hand) {
  if (name == "white") return Texture(kWidth, kHeight, 0xffffffff);
  if (name != "atlas" && name != "checker" && name != "skeleton") return std::nullopt;
  const ChartMap charts(hand, kWidth, kHeight);
  if (name == "checker") return paint(charts, checker);
  if (name == "atlas")
    return paint(charts, [atlas = Atlas(charts)](const ChartTexel& texel, int, int) mutable {
      return atlas(texel);
    });
  return paint(charts, [skeleton = Skeleton(hand)](const ChartTexel& texel, int, int) {
    return skeleton(texel);
  });
}

}  // namespace handcast::renderer
