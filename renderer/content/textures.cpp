// SPDX-License-Identifier: Apache-2.0
#include "renderer/content/textures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/quote.hpp"
#include "renderer/content/chart_map.hpp"
#include "renderer/content/lettering.hpp"
#include "renderer/media/picture.hpp"

namespace handcast::renderer {
namespace {

constexpr int kWidth = 1024, kHeight = 640;

using Colour = glm::vec3;  ///< red, green, blue, 0..255
constexpr Colour kPaper{252, 248, 240}, kInk{24, 28, 44};

std::uint32_t packed(Colour colour) {
  // In double the sum is exact, so this rounds like std::lround(), which is a slow call.
  const auto byte = [](float value) {
    const double rounded = static_cast<double>(std::clamp(value, 0.f, 255.f)) + 0.5;
    return static_cast<std::uint32_t>(rounded);
  };
  return 0xff000000u | byte(colour.b) << 16 | byte(colour.g) << 8 | byte(colour.r);
}

/// The largest whole number that is at most `value`, which must fit into an int. Much faster than
/// std::floor() on processors without SSE 4.1, for which this is compiled.
int whole_below(float value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < static_cast<float>(towards_zero) ? 1 : 0);
}

/// The distance to the nearest multiple of `step`.
float to_multiple(float value, float step) {
  const float steps = value / step;
  return std::abs(steps - static_cast<float>(whole_below(steps + 0.5f))) * step;
}

/// `colour` with `over` painted over it. Most texels are not covered.
Colour covered(Colour colour, Colour over, float coverage) {
  return coverage == 0 ? colour : glm::mix(colour, over, coverage);
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
    const glm::vec2 place = texel.rest_mm;
    const glm::ivec2 field{whole_below(place.x / kFieldMm), whole_below(place.y / kFieldMm)};
    const glm::vec2 from_centre = place - (glm::vec2(field) + 0.5f) * kFieldMm;
    const float facing = charts_.facing(texel.chart);
    Colour colour = ground(texel, field, facing);
    const float to_fine = std::min(to_multiple(place.x, kFineMm), to_multiple(place.y, kFineMm));
    colour = covered(colour, kPaper, 0.45f * line(to_fine, 0.15f, 0.25f));
    const glm::vec2 to_border = kFieldMm / 2 - glm::abs(from_centre);
    colour = covered(colour, kInk, 0.8f * line(std::min(to_border.x, to_border.y), 0.3f, 0.3f));
    // As seen when looking at this side with the fingers up.
    const glm::vec2 right_up{facing * from_centre.x, -from_centre.y};
    return covered(colour, kInk, coverage(label(texel, field, facing), right_up));
  }

 private:
  static constexpr float kFieldMm = 16, kFineMm = 4, kLetterMm = 5.5f;
  static constexpr int kLetterPx = 56;

  static Colour ground(const ChartTexel& texel, glm::ivec2 field, float facing) {
    static constexpr std::array<Colour, kFingers> kColours{
        Colour{236, 94, 80}, {244, 168, 54}, {112, 190, 88}, {64, 156, 220}, {158, 108, 214}};
    const int finger = finger_of(texel.joint);
    if (finger >= 0) return kColours[finger] * (bone_of(texel.joint) % 2 == 0 ? 1.f : 0.72f);
    const bool dark = (field.x + field.y) % 2 != 0;
    if (facing > 0) return dark ? Colour{120, 196, 190} : Colour{170, 224, 214};
    return dark ? Colour{238, 176, 140} : Colour{250, 212, 180};
  }

  /// What stands in a field.
  struct Label {
    int finger;    ///< 0 thumb to 4 little finger; -1: a field of the back or the palm
    bool is_back;  ///< the other side is the palm
    int column, row;
  };
  static constexpr int kColumns = 10, kRows = 100, kFingers = 5;

  static Label label(const ChartTexel& texel, glm::ivec2 field, float facing) {
    return {finger_of(texel.joint), facing > 0, std::clamp(field.x + 4, 0, kColumns - 1),
            std::clamp(6 - field.y, 0, kRows - 1)};
  }
  /// The letter of the column (A, B, ... on the back, P, Q, ... on the palm) and the number of the
  /// row from the forearm up. On fingers: 1 (thumb) to 5.
  static std::string text_of(const Label& label) {
    if (label.finger >= 0) return std::to_string(label.finger + 1);
    return fmt::format("{}{}", static_cast<char>((label.is_back ? 'A' : 'P') + label.column),
                       label.row);
  }

  /// The letters of a label, drawn when they are first needed.
  const Image<std::uint8_t>& letters_of(const Label& label) {
    const int field = ((label.is_back ? 0 : kColumns) + label.column) * kRows + label.row;
    auto& letters = letters_[label.finger >= 0 ? label.finger : kFingers + field];
    if (letters.width() == 0) letters = lettering(text_of(label), kLetterPx);
    return letters;
  }

  /// Coverage by the letters of a label at a point, in mm from the middle of the field.
  float coverage(const Label& label, glm::vec2 right_up_mm) {
    const float px_per_mm = kLetterPx / kLetterMm;
    const int y = whole_below(kLetterPx / 2.f - right_up_mm.y * px_per_mm);
    if (y < 0 || y >= kLetterPx) return 0;
    const Image<std::uint8_t>& letters = letters_of(label);
    const int x = whole_below(letters.width() / 2.f + right_up_mm.x * px_per_mm);
    return x < 0 || x >= letters.width() ? 0 : letters.at(x, y) / 255.f;
  }

  const ChartMap& charts_;
  std::vector<Image<std::uint8_t>> letters_{kFingers + 2 * kColumns * kRows};
};

/// Bones and joints where they lie under the skin, seen from the back or from the palm.
class Skeleton {
 public:
  explicit Skeleton(const HandMesh& hand) {
    for (int joint = 0; joint < kJoints; ++joint)
      joints_mm_[joint] = xz_of(in_wrist_mm(hand, 1000.f * glm::vec3(hand.rest[joint][3])));
  }

  Colour operator()(const ChartTexel& texel) const {
    const glm::vec2 place = texel.rest_mm;
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
  static glm::vec2 xz_of(const glm::vec3& place) { return {place.x, place.z}; }
  static float distance_to_segment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
    const glm::vec2 along = b - a;
    const float length2 = std::max(glm::dot(along, along), 1e-6f);
    return glm::distance(p, a + along * std::clamp(glm::dot(p - a, along) / length2, 0.f, 1.f));
  }

  std::array<glm::vec2, kJoints> joints_mm_;
};

/// A texel on the outline of a chart.
struct Outlined {
  int x, y;
  Colour colour;
};

/// Paints all texels, pads the charts outwards, and draws their outlines last, so that the fill
/// finds the content outside a chart and not its outline. `colour_of`: a function of the texel and
/// its column and row that returns a Colour.
template <class ColourOf>
Texture paint(const ChartMap& charts, ColourOf colour_of) {
  Texture texture(kWidth, kHeight, packed(kInk));
  std::vector<Outlined> outlines;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const ChartTexel& texel = charts.at(x, y);
      if (texel.chart == 0) continue;
      const Colour colour = colour_of(texel, x, y);
      texture.at(x, y) = packed(colour);
      if (const float outline = line(texel.edge_px, 2, 1); outline > 0)
        outlines.push_back({x, y, glm::mix(colour, kPaper, outline)});
    }
  }
  charts.pad(texture);
  for (const auto& [x, y, colour] : outlines) texture.at(x, y) = packed(colour);
  return texture;
}

/// Squares of 32 texels, which show how the texture layout distorts lengths.
Colour checker(const ChartTexel& texel, int x, int y) {
  const Colour light = texel.chart % 2 == 1 ? Colour{250, 240, 210} : Colour{214, 236, 250};
  return (x / 32 + y / 32) % 2 == 0 ? light : Colour{32, 60, 96};
}

/// The names of the built-in contents, for messages.
constexpr std::string_view kBuiltinNames = "atlas, checker, skeleton, white";

/// Paints one of kBuiltinNames over the charts of `hand`. Empty if there is no such name.
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

}  // namespace

Result<Texture> load_content(const std::string& what, const HandMesh& hand) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (!what.starts_with(kBuiltin)) return read_picture(what);
  const std::string name = what.substr(kBuiltin.size());
  if (auto texture = paint_builtin(name, hand)) return std::move(*texture);
  return fail(Errc::bad_config, fmt::format("There is no built-in content {}; the names are {}.",
                                            quote(name), kBuiltinNames));
}

std::string note_on_proportions(const std::string& what, const Texture& picture) {
  constexpr double kSame = 0.01;
  const double wider = static_cast<double>(picture.width()) * kHeight / picture.height() / kWidth;
  if (std::abs(wider - 1) <= kSame) return {};
  return fmt::format(
      "the picture '{}' has {} x {} px, its template {} x {}: it is stretched to {:.0f} % of its "
      "{}; paint on the template, which `handcast template` writes",
      what, picture.width(), picture.height(), kWidth, kHeight, 100 * std::max(wider, 1 / wider),
      wider > 1 ? "height" : "width");
}

}  // namespace handcast::renderer
