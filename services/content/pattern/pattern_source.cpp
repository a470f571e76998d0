// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "renderer/content/chart_map.hpp"
#include "renderer/content/lettering.hpp"
#include "renderer/content/textures.hpp"
#include "services/content/scaled.hpp"
#include "services/content/settable_source.hpp"

namespace handcast::content {
namespace {

using renderer::ChartMap;
using renderer::HandMesh;
using renderer::Texture;

using Colour = glm::vec3;  ///< red, green, blue, 0..1

std::uint32_t packed(Colour colour) {
  const auto byte = [](float value) {
    return static_cast<std::uint32_t>(std::lround(255 * std::clamp(value, 0.f, 1.f)));
  };
  return 0xff000000u | byte(colour.b) << 16 | byte(colour.g) << 8 | byte(colour.r);
}

/// A colour of full strength: hue 0..1 from red by green and blue to red.
Colour hue(float at) {
  const auto channel = [at](float peak) {
    const float away = std::abs(at - peak), turned = std::min(away, 1 - away);
    return std::clamp(2 - 6 * turned, 0.f, 1.f);
  };
  return {channel(0), channel(1 / 3.f), channel(2 / 3.f)};
}

/// Dark blue by cyan, green and yellow to red.
Colour heat(double value) {
  const auto at = static_cast<float>(std::clamp(value, 0., 1.));
  const float strength = std::min(1.f, 0.35f + 3 * at);
  return strength * hue((1 - at) * 2 / 3);
}

/// Neighbouring joints differ in hue, and those of a finger in strength.
Colour colour_of_joint(int joint) {
  if (joint < 2) return Colour(0.55f + 0.25f * static_cast<float>(joint));
  const int finger = joint < 6 ? 0 : 1 + (joint - 6) / 5;
  const int bone = joint < 6 ? joint - 2 : (joint - 6) % 5;
  return hue(static_cast<float>(finger) / 5) * (1 - 0.17f * static_cast<float>(bone));
}

/// Paints each texel on a chart, and continues the colours outside.
template <class ColourOf>
void paint(const HandMesh& hand, Texture& out, ColourOf colour_of) {
  const ChartMap charts(hand, out.width(), out.height());
  std::ranges::fill(out.pixels(), 0xff000000u);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if (const auto& texel = charts.at(x, y); texel.chart != 0)
        out.at(x, y) = packed(colour_of(texel, x, y));
  charts.pad(out);
}

/// The skin weight of a joint on each texel: its triangles are drawn with the weights of their
/// corners. Texels that no triangle covers have 0.
class WeightMap {
 public:
  WeightMap(const HandMesh& hand, int joint, int width, int height) : weights_(width, height) {
    for (const auto& corners : hand.triangles) {
      glm::vec3 weights{0};
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 4; ++i)
          if (hand.joints[corners[k]][i] == joint) weights[k] += hand.weights[corners[k]][i];
      if (weights != glm::vec3(0)) draw(hand, corners, weights);
    }
  }
  float at(int x, int y) const { return weights_.at(x, y); }

 private:
  void draw(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners,
            const glm::vec3& weights) {
    constexpr float kSlack = 1e-4f;
    const glm::vec2 size(weights_.width(), weights_.height());
    const auto at = [&](int k) { return hand.uv[corners[k]] * size - 0.5f; };
    const glm::vec2 a = at(0), ab = at(1) - a, ac = at(2) - a;
    const float area = ab.x * ac.y - ab.y * ac.x;
    if (area == 0) return;
    const auto box =
        renderer::Rect{static_cast<int>(std::ceil(a.x + std::min({0.f, ab.x, ac.x}))),
                       static_cast<int>(std::ceil(a.y + std::min({0.f, ab.y, ac.y}))),
                       static_cast<int>(std::floor(a.x + std::max({0.f, ab.x, ac.x}))) + 1,
                       static_cast<int>(std::floor(a.y + std::max({0.f, ab.y, ac.y}))) + 1}
            .within(weights_.width(), weights_.height());
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x) {
        const glm::vec2 ap = glm::vec2(x, y) - a;
        const float b = (ap.x * ac.y - ap.y * ac.x) / area, c = (ab.x * ap.y - ab.y * ap.x) / area;
        if (std::min({b, c, 1 - b - c}) < -kSlack) continue;
        weights_.at(x, y) = glm::dot(weights, glm::vec3(1 - b - c, b, c));
      }
  }

  renderer::Image<float> weights_;
};

/// The charts, each in its colour, and their outlines.
void paint_seams(const HandMesh& hand, Texture& out) {
  std::vector<glm::ivec2> outline;
  paint(hand, out, [&](const renderer::ChartTexel& texel, int x, int y) {
    if (texel.edge_px <= 2) outline.emplace_back(x, y);
    return 0.45f * hue(0.58f + 0.382f * static_cast<float>(texel.chart % 5) -
                       std::floor(0.58f + 0.382f * static_cast<float>(texel.chart % 5)));
  });
  for (const auto& place : outline) out.at(place.x, place.y) = 0xffffffffu;
}

/// A dot and a number where each joint lies under the skin, in the colour of its finger.
void paint_joints(const HandMesh& hand, Texture& out) {
  constexpr float kDot_mm = 4.5f, kLetter_mm = 4;
  constexpr int kLetterPx = 32;
  std::array<glm::vec2, renderer::kJoints> places;
  std::array<renderer::Image<std::uint8_t>, renderer::kJoints> numbers;
  for (int joint = 0; joint < renderer::kJoints; ++joint) {
    const auto place = renderer::in_wrist_mm(hand, 1000.f * glm::vec3(hand.rest[joint][3]));
    places[joint] = {place.x, place.z};
    numbers[joint] = renderer::lettering(std::to_string(joint), kLetterPx);
  }
  const ChartMap charts(hand, out.width(), out.height());
  paint(hand, out, [&](const renderer::ChartTexel& texel, int, int) -> Colour {
    for (int joint = 0; joint < renderer::kJoints; ++joint) {
      const glm::vec2 away = texel.rest_mm - places[joint];
      if (glm::dot(away, away) > kDot_mm * kDot_mm) continue;
      // As seen when looking at this side with the fingers up.
      const auto& number = numbers[joint];
      const auto from_middle = glm::vec2(charts.facing(texel.chart) * away.x, away.y) *
                               (static_cast<float>(kLetterPx) / kLetter_mm);
      const int x = static_cast<int>(std::floor(from_middle.x)) + number.width() / 2,
                y = static_cast<int>(std::floor(from_middle.y)) + kLetterPx / 2;
      const bool is_inside = x >= 0 && x < number.width() && y >= 0 && y < kLetterPx;
      const float ink = is_inside ? static_cast<float>(number.at(x, y)) / 255 : 0;
      return (1 - ink) * colour_of_joint(joint);
    }
    return {0.08f, 0.1f, 0.18f};
  });
}

/// Each part of the skin in the colour of the joint that moves it most.
void paint_bones(const HandMesh& hand, Texture& out) {
  paint(hand, out,
        [](const renderer::ChartTexel& texel, int, int) { return colour_of_joint(texel.joint); });
}

/// The skin weight of one joint: dark blue 0, red 1.
void paint_weights(const HandMesh& hand, int joint, Texture& out) {
  const WeightMap weights(hand, joint, out.width(), out.height());
  paint(hand, out, [&](const renderer::ChartTexel&, int x, int y) {
    return heat(static_cast<double>(weights.at(x, y)));
  });
}

/// The joint that moves each part of the skin most, plus 1, as the red of a picture; 0: none.
Texture joints_of(const HandMesh& hand, int width, int height) {
  Texture joints(width, height);
  paint(hand, joints, [](const renderer::ChartTexel& texel, int, int) {
    return Colour(static_cast<float>(texel.joint + 1) / 255, 0, 0);
  });
  return joints;
}

/// The same as paint_weights() for a value 0..1 of each joint, on the skin that it moves most.
void paint_bars(const Texture& joints, const std::array<double, kJoints>& values, Texture& out) {
  std::array<std::uint32_t, 256> colours;
  colours.fill(0xff000000u);
  for (int joint = 0; joint < kJoints; ++joint) colours[joint + 1] = packed(heat(values[joint]));
  std::ranges::transform(joints.pixels(), out.pixels().begin(),
                         [&](std::uint32_t pixel) { return colours[pixel & 255]; });
}

constexpr std::string_view kNames[] = {"atlas", "checker", "skeleton", "white",
                                       "seams", "joints",  "bones",    "bars"};

constexpr int kNoJoint = -1;

std::vector<Parameter> parameters_of(std::string_view name) {
  if (name == "bones") {
    std::vector<std::string> choices{"all"};
    for (const auto joint : renderer::kJointNames) choices.emplace_back(joint);
    auto joint =
        choice_parameter("joint", "The joint whose skin weights are shown", std::move(choices));
    for (double& value : joint.values) value += kNoJoint;
    joint.initial = joint.least = {kNoJoint};
    joint.most = {kJoints - 1.};
    return {joint};
  }
  if (name != "bars") return {};
  std::vector<Parameter> parameters;
  for (int joint = 0; joint < kJoints; ++joint)
    parameters.push_back(number_parameter(fmt::format("value{}", joint),
                                          std::string(renderer::kJointNames[joint]), 0, 1, 0));
  parameters.push_back(plain_parameter("values", "The values of the joints from the first on, 0..1",
                                       Parameter::Kind::text));
  return parameters;
}

class PatternSource final : public SettableSource {
 public:
  PatternSource(std::string name, const HandMesh* hand)
      : SettableSource(parameters_of(name)), name_(std::move(name)), hand_(hand) {}

  Result<void> set(std::string_view name, std::string_view value) override {
    if (name != "values") return SettableSource::set(name, value);
    const auto parts = static_cast<int>(std::ranges::count(value, ',')) + 1;
    if (parts > kJoints)
      return fail(Errc::bad_config,
                  fmt::format("values: {} are too many; a hand has {} joints", parts, kJoints));
    for (int joint = 0; joint < parts; ++joint) {
      const auto comma = value.find(',');
      if (auto set = SettableSource::set(fmt::format("value{}", joint), value.substr(0, comma));
          !set)
        return set;
      if (comma != value.npos) value.remove_prefix(comma + 1);
    }
    return {};
  }

  Result<bool> draw(const Moment&, std::span<const renderer::View<const std::uint32_t>>,
                    Texture& out) override {
    if (!take_change()) return false;
    if (name_ == "white") {
      std::ranges::fill(out.pixels(), 0xffffffffu);
    } else if (name_ == "seams") {
      paint_seams(*hand_, out);
    } else if (name_ == "joints") {
      paint_joints(*hand_, out);
    } else if (name_ == "bones") {
      const int joint = static_cast<int>(number("joint"));
      joint == kNoJoint ? paint_bones(*hand_, out) : paint_weights(*hand_, joint, out);
    } else if (name_ == "bars") {
      std::array<double, kJoints> values;
      for (int joint = 0; joint < kJoints; ++joint)
        values[joint] = number(fmt::format("value{}", joint));
      if (joints_.width() == 0) joints_ = joints_of(*hand_, out.width(), out.height());
      paint_bars(joints_, values, out);
    } else {
      const auto painted = renderer::load_content("builtin:" + name_, *hand_);
      if (!painted) return tl::make_unexpected(painted.error());
      out = scaled(painted->view(), out.width(), out.height());
    }
    return true;
  }

 private:
  std::string name_;
  const HandMesh* hand_;  ///< null only for white
  Texture joints_;        ///< of bars: joints_of()
};

}  // namespace

Result<std::unique_ptr<Source>> open_pattern(const Opening& opening) {
  const std::string& name = opening.element.what;
  if (std::ranges::find(kNames, name) == std::end(kNames))
    return fail(Errc::bad_config, fmt::format("there is no pattern {}; there are: {}", quote(name),
                                              join(std::span(kNames), ", ")));
  const auto* hand = opening.meshes[opening.side == Side::left ? 0 : 1];
  if (!hand && name != "white")
    return fail(
        Errc::bad_config,
        fmt::format("pattern '{}' shows the layout of a hand, and there is none here", name));
  return std::make_unique<PatternSource>(name, hand);
}

}  // namespace handcast::content
