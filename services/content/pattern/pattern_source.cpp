// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "renderer/content/textures.hpp"
#include "services/content/pattern/bone_patterns.hpp"
#include "services/content/scaled.hpp"
#include "services/content/settable_source.hpp"

namespace handcast::content {
namespace {

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
      paint_bars(*hand_, values, out);
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
