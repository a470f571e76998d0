// SPDX-License-Identifier: Apache-2.0
#include "services/desk/rig_panel.hpp"

#include <fmt/format.h>

#include <utility>

#include "config/live/live_values.hpp"
#include "config/live_files.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::desk {
namespace {

Kind kind_of(const config::Setting& setting) {
  constexpr std::array kKinds{Kind::toggle,  Kind::whole, Kind::number, Kind::text,
                              Kind::numbers, Kind::texts, Kind::choice};
  return kKinds[setting.target.index()];
}

/// Calls `use` with each live setting of a rig.
template <class Use>
void for_live(config::Rig& rig, const Use& use) {
  for (const auto& section : config::list_settings(rig))
    for (const auto& setting : section.settings)
      if (setting.effect == config::Effect::live) use(setting);
}

}  // namespace

std::vector<Control> controls_of(config::Rig filed) {
  std::vector<Control> controls;
  for_live(filed, [&](const config::Setting& setting) {
    const auto words = setting.words();
    controls.push_back({.path = setting.path,
                        .kind = kind_of(setting),
                        .range = setting.range,
                        .words = {words.begin(), words.end()},
                        .sentence = std::string(setting.sentence),
                        .initial = {},
                        .filed = config::print_value(setting)});
  });
  config::Rig plain;
  std::size_t i = 0;
  for_live(plain, [&](const config::Setting& setting) {
    controls[i++].initial = config::print_value(setting);
  });
  return controls;
}

RigPanel::RigPanel(config::LiveBoard board)
    : board_(std::move(board)), controls_(controls_of(board_.filed())) {}

std::shared_ptr<const Values> RigPanel::values() const {
  const std::lock_guard lock(mutex_);
  const auto now = board_.now();
  if (now && values_ && values_->revision == now->header.frame_id) return values_;
  auto rig = now ? config::with_live(board_.filed(), now->values.view())
                 : Result<config::Rig>(board_.filed());
  if (!rig) {
    if (values_) return values_;
    rig = board_.filed();
  }
  auto values = std::make_shared<Values>();
  for_live(*rig, [&](const config::Setting& setting) {
    values->toml.push_back(config::print_value(setting));
  });
  if (now) {
    values->revision = now->header.frame_id;
    values->source = now->source.view();
    values->change = now->change.view();
    values->can_undo = !now->undo.view().empty();
    values->can_redo = !now->redo.view().empty();
  }
  return values_ = std::move(values);
}

/// Writes a change into the log.
Result<void> RigPanel::noted(const Result<std::uint64_t>& change, std::string_view what,
                             std::string_view source) const {
  if (!change) return tl::make_unexpected(change.error());
  log::debug("{}: {}", printable(source), printable(what));
  return {};
}

Result<void> RigPanel::set(std::span<const std::string> assignments, std::string_view source) {
  const std::lock_guard lock(mutex_);
  const std::vector<std::string> parts(assignments.begin(), assignments.end());
  return noted(board_.set(assignments, source), join(parts, ", "), source);
}

Result<void> RigPanel::undo(std::string_view source) {
  const std::lock_guard lock(mutex_);
  return noted(board_.undo(source), "undo", source);
}

Result<void> RigPanel::redo(std::string_view source) {
  const std::lock_guard lock(mutex_);
  return noted(board_.redo(source), "redo", source);
}

std::vector<std::string> RigPanel::presets() const { return config::preset_names(board_.file()); }

Result<void> RigPanel::load(std::string_view preset, std::string_view source) {
  const std::lock_guard lock(mutex_);
  return noted(board_.load(preset, source), fmt::format("preset {}", preset), source);
}

Result<void> RigPanel::store(std::string_view preset) {
  const std::lock_guard lock(mutex_);
  return board_.store(preset);
}

Result<void> RigPanel::save() {
  const std::lock_guard lock(mutex_);
  return board_.save();
}

Result<void> RigPanel::show(std::string_view hand, std::string_view content,
                            std::string_view source) {
  if (hand != "left" && hand != "right" && hand != "both")
    return fail(Errc::bad_config,
                fmt::format("{} is no hand; write left, right or both", quote(hand)));
  std::vector<std::string> changes;
  for (const std::string_view each : {"left", "right"})
    if (hand == "both" || hand == each)
      changes.push_back(fmt::format("content.{}={}", each, content));
  return set(changes, source);
}

}  // namespace handcast::desk
