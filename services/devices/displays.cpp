// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "services/devices/attached.hpp"
#ifdef HANDCAST_WITH_WINDOW
#include "renderer/window/monitor.hpp"
#include "renderer/window/window.hpp"
#endif
#ifdef HANDCAST_WITH_KMS
#include "ipc/base/join.hpp"
#include "renderer/kms/card.hpp"
#endif

namespace handcast::devices {

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
         .trouble = {}});
  }
  return attached;
}
#else
std::vector<Attached> monitors() { return {}; }
#endif

#ifdef HANDCAST_WITH_KMS
namespace {

Attached entry_of(const renderer::kms::Display& display) {
  return {
      .kind = Kind::display,
      .name = fmt::format("{} of {}", describe(display), display.card),
      .about = "without a window system",
      .settings = {{"projector.backend", "kms"}, {"projector.kms.connector", display.connector}},
      .trouble = {}};
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
