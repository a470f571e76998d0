// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "services/tools/devices/attached.hpp"
#ifdef HANDCAST_WITH_WINDOW
#include "renderer/window/monitor.hpp"
#include "renderer/window/window.hpp"
#endif
#ifdef HANDCAST_WITH_KMS
#include "renderer/kms/card.hpp"
#endif

namespace handcast::devices {

/// The model in the EDID, which not every display has, moves with the display to another connector.
[[maybe_unused]] static std::vector<std::string> names_of(const std::string& model,
                                                          const std::string& connector) {
  if (model.empty()) return {connector};
  return {model, connector};
}

#ifdef HANDCAST_WITH_WINDOW
std::vector<Attached> monitors() {
  const auto found = renderer::list_monitors();
  if (!found)
    return {{.kind = Kind::display,
             .name = "window system",
             .about = {},
             .settings = {{"projector.backend", "window"}},
             .trouble = found.error().what}};
  std::vector<Attached> attached;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const auto& monitor = (*found)[i];
    attached.push_back(
        {.kind = Kind::display,
         .name = renderer::describe(monitor, i),
         .about = monitor.is_primary ? "the primary one, probably the operator's" : "",
         .settings = {{"projector.backend", "window"},
                      {"projector.window.monitor", monitor.output}},
         .names = names_of(monitor.model, monitor.output),
         .modes = {{.least_width_px = monitor.width_px,
                    .least_height_px = monitor.height_px,
                    .width_px = monitor.width_px,
                    .height_px = monitor.height_px,
                    .rate_hz = monitor.rate_hz}},
         .is_operators = monitor.is_primary});
  }
  return attached;
}
#else
std::vector<Attached> monitors() { return {}; }
#endif

#ifdef HANDCAST_WITH_KMS
namespace {

/// The panel of a laptop, by the kernel's names of its connectors.
bool is_built_in(std::string_view connector) {
  return connector.starts_with("eDP") || connector.starts_with("LVDS") ||
         connector.starts_with("DSI");
}

Attached entry_of(const renderer::kms::Display& display) {
  Attached entry{
      .kind = Kind::display,
      .name = fmt::format("{} of {}", describe(display), display.card),
      .about = "without a window system",
      .settings = {{"projector.backend", "kms"}, {"projector.kms.connector", display.connector}},
      .names = names_of(display.model, display.connector),
      .is_operators = is_built_in(display.connector)};
  for (const auto& mode : display.modes)
    entry.modes.push_back({.least_width_px = mode.width_px,
                           .least_height_px = mode.height_px,
                           .width_px = mode.width_px,
                           .height_px = mode.height_px,
                           .rate_hz = mode.rate_hz});
  return entry;
}

}  // namespace

std::vector<Attached> connectors() {
  std::vector<Attached> attached;
  std::error_code error;
  for (int i = 0; i < 16; ++i) {
    const auto path = fmt::format("/dev/dri/card{}", i);
    if (!std::filesystem::exists(path, error)) continue;
    const auto card = renderer::kms::open_card(path);
    if (!card) {
      attached.push_back({.kind = Kind::display,
                          .name = path,
                          .about = "without a window system",
                          .settings = {{"projector.backend", "kms"}},
                          .trouble = card.error().what});
      continue;
    }
    for (const auto& display : renderer::kms::displays_of(card->get(), path))
      if (display.is_connected) attached.push_back(entry_of(display));
  }
  return attached;
}
#else
std::vector<Attached> connectors() { return {}; }
#endif

}  // namespace handcast::devices
