// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/sections/cascade.hpp"
#include "config/sections/light.hpp"
#include "config/settings/load.hpp"
#include "config/settings/settings.hpp"
#include "services/desk/base/panel.hpp"

namespace handcast::test {

/// The settings of a TablePanel: at least one of each kind, named as those of a rig.
struct Turned {
  double brightness = 1;
  int cells = 8;
  bool blackout = false, freeze = false;
  double master = 1;
  config::Lamp lamp = config::Lamp::unchanged;
  std::vector<std::string> keep_out;
  std::string left = "builtin:atlas";
  std::string transition = "fade";
  double transition_s = 0.6;
  std::vector<double> gravity{0, 1, 0};
  config::PredictMethod method = config::PredictMethod::hold;
};

/// Declares them as `projector.brightness`, `light.blackout`, and so on.
inline config::Listing list_turned(Turned& turned) {
  using config::between;
  config::Listing listing(1);
  const auto add = [&](const char* path, config::Target target, config::Range range,
                       const char* sentence) {
    listing[0].settings.push_back({path, std::move(target), range, sentence, config::Effect::live});
  };
  add("projector.brightness", &turned.brightness, between(0, 1), "Share of the light.");
  add("projector.fill.cells", &turned.cells, between(1, 64, "px"), "Cells of the fill.");
  add("light.blackout", &turned.blackout, {}, "No light at all.");
  add("light.freeze", &turned.freeze, {}, "The light stays as it is.");
  add("light.master", &turned.master, between(0, 1), "Share of the brightness.");
  add("light.lamp", config::ChoiceTarget::of(turned.lamp), {}, "What the lamp is told.");
  add("light.keep_out", &turned.keep_out, {}, "Areas that stay dark.");
  add("content.left", &turned.left, {}, "What is on the left hand.");
  add("content.transition", &turned.transition, {}, "How one content becomes another.");
  add("content.transition_s", &turned.transition_s, between(0, 60, "s"), "How long that takes.");
  add("content.gravity", &turned.gravity, between(-1, 1), "Down.");
  add("cascade.predict.method", config::ChoiceTarget::of(turned.method), {}, "The prediction.");
  return listing;
}

/// A panel in memory, which checks values as a rig does and records what was asked of it.
class TablePanel final : public desk::Panel {
 public:
  TablePanel() {
    for (const auto& setting : listing_[0].settings) controls_.push_back(control_of(setting));
    publish("", "");
  }

  std::span<const desk::Control> controls() const override { return controls_; }
  std::shared_ptr<const desk::Values> values() const override {
    const std::lock_guard lock(mutex_);
    return values_;
  }

  Result<void> set(std::span<const std::string> assignments, std::string_view source) override {
    const std::lock_guard lock(mutex_);
    if (!refusal.empty()) return fail(Errc::unavailable, refusal);
    Turned before = turned_;
    config::Faults faults;
    for (const auto& assignment : assignments)
      config::apply_assignment(filed_if_bare(assignment), listing_, faults);
    if (!faults.empty()) {
      turned_ = std::move(before);
      return tl::make_unexpected(faults.to_error());
    }
    sets.emplace_back(assignments.begin(), assignments.end());
    undo_.push_back(std::move(before));
    redo_.clear();
    publish(source, assignments.empty() ? "" : assignments.back());
    return {};
  }
  Result<void> undo(std::string_view source) override { return step(undo_, redo_, source); }
  Result<void> redo(std::string_view source) override { return step(redo_, undo_, source); }

  std::vector<std::string> presets() const override {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> names;
    for (const auto& [name, turned] : presets_) names.push_back(name);
    return names;
  }
  Result<void> load(std::string_view preset, std::string_view source) override {
    const std::lock_guard lock(mutex_);
    const auto found = presets_.find(std::string(preset));
    if (found == presets_.end())
      return fail(Errc::bad_config, "there is no preset '" + std::string(preset) + "'");
    undo_.push_back(turned_);
    turned_ = found->second;
    loads.emplace_back(preset);
    publish(source, "preset " + std::string(preset));
    return {};
  }
  Result<void> store(std::string_view preset) override {
    const std::lock_guard lock(mutex_);
    presets_[std::string(preset)] = turned_;
    return {};
  }
  Result<void> save() override { return {}; }

  Result<void> show(std::string_view hand, std::string_view content,
                    std::string_view source) override {
    const std::lock_guard lock(mutex_);
    shown.emplace_back(std::string(hand), std::string(content));
    publish(source, std::string(content));
    return {};
  }

  /// The value of a control as TOML; "" if there is none.
  std::string value(std::string_view path) const {
    const auto at = desk::find_control(controls_, path);
    return at ? values()->toml[*at] : "";
  }
  /// Who made the last change.
  std::string source() const { return values()->source; }

  /// What was asked for, in its order. Read it when no other thread changes anything.
  /// @{
  std::vector<std::vector<std::string>> sets;
  std::vector<std::pair<std::string, std::string>> shown;  ///< hand and content
  std::vector<std::string> loads;
  /// @}
  std::string refusal;  ///< not empty: set() fails with it (unavailable)

 private:
  static desk::Kind kind_of(const config::Target& target) {
    using desk::Kind;
    constexpr Kind kKinds[] = {Kind::toggle,  Kind::whole, Kind::number, Kind::text,
                               Kind::numbers, Kind::texts, Kind::choice};
    return kKinds[target.index()];
  }
  static desk::Control control_of(const config::Setting& setting) {
    const auto words = setting.words();
    const auto value = config::print_value(setting);
    return {setting.path,
            kind_of(setting.target),
            setting.range,
            {words.begin(), words.end()},
            std::string(setting.sentence),
            value,
            value};
  }
  std::string filed_if_bare(const std::string& assignment) const {
    if (assignment.find('=') != std::string::npos) return assignment;
    const auto at = desk::find_control(controls_, assignment);
    return at ? assignment + "=" + controls_[*at].filed : assignment + "=";
  }
  Result<void> step(std::vector<Turned>& from, std::vector<Turned>& to, std::string_view source) {
    const std::lock_guard lock(mutex_);
    if (from.empty()) return fail(Errc::bad_config, "there is no change to take back or do again");
    to.push_back(std::exchange(turned_, from.back()));
    from.pop_back();
    publish(source, "undo");
    return {};
  }
  void publish(std::string_view source, std::string change) {
    auto values = std::make_shared<desk::Values>();
    values->revision = values_ ? values_->revision + 1 : 1;
    for (const auto& setting : listing_[0].settings)
      values->toml.push_back(config::print_value(setting));
    values->source = source;
    values->change = std::move(change);
    values->can_undo = !undo_.empty();
    values->can_redo = !redo_.empty();
    values_ = std::move(values);
  }

  mutable std::mutex mutex_;
  Turned turned_;
  config::Listing listing_ = list_turned(turned_);
  std::vector<desk::Control> controls_;
  std::shared_ptr<const desk::Values> values_;
  std::vector<Turned> undo_, redo_;
  std::map<std::string, Turned> presets_;
};

}  // namespace handcast::test
