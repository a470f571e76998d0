// SPDX-License-Identifier: Apache-2.0
#include "services/watch/lights.hpp"

#include <fmt/format.h>

#include <vector>

#include "config/live/live_values.hpp"

namespace handcast::watch {

Result<void> Lights::turn(bool on) {
  std::vector<std::string> changes{fmt::format("light.blackout={}", !on)};
  if (has_lamp()) changes.push_back(on ? "light.lamp=on" : "light.lamp=off");
  const auto set = board_.set(changes, "night watch");
  return set ? Result<void>() : tl::make_unexpected(set.error());
}

std::optional<Lights::Change> Lights::look() {
  const auto now = board_.now();
  if (!now || seen_ == now->header.frame_id) return std::nullopt;
  const bool is_first = !seen_;
  seen_ = now->header.frame_id;
  if (const auto rig = board_.rig_now()) {
    const auto& light = rig->light;
    const bool has_light = light.lamp == config::Lamp::on || light.lamp == config::Lamp::unchanged;
    is_dark_ = !config::why_dark(light).empty() || (has_lamp() && !has_light);
  }
  if (is_first) return std::nullopt;
  return Change{std::string(now->source.view()), std::string(now->change.view())};
}

}  // namespace handcast::watch
