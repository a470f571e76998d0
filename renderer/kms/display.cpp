// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/display.hpp"

#include <fmt/format.h>

#include "ipc/base/join.hpp"

namespace handcast::renderer::kms {
namespace {

std::string list_of(std::span<const Display> displays) {
  if (displays.empty()) return "the card has no connector";
  std::vector<std::string> texts;
  texts.reserve(displays.size());
  for (const auto& display : displays) texts.push_back(describe(display));
  return "the connectors are " + join(texts, ", ");
}

std::string sentence_of(std::size_t fitting, std::string_view wanted) {
  if (fitting > 1)
    return wanted.empty() ? "several displays are connected"
                          : fmt::format("several displays are called '{}'", wanted);
  return wanted.empty() ? "no display is connected"
                        : fmt::format("there is no display '{}'", wanted);
}

}  // namespace

std::string describe(const Display& display) {
  if (!display.is_connected) return fmt::format("'{}' (empty)", display.connector);
  const auto mode = display.modes.empty() ? "no mode" : describe(display.modes.front());
  return fmt::format("'{}' ({}{})", display.connector,
                     display.model.empty() ? "" : display.model + ", ", mode);
}

Result<std::size_t> choose_display(std::span<const Display> displays, std::string_view wanted) {
  std::vector<std::size_t> fit;
  for (std::size_t i = 0; i < displays.size(); ++i) {
    const auto& display = displays[i];
    if (display.is_connected &&
        (wanted.empty() || wanted == display.connector || wanted == display.model))
      fit.push_back(i);
  }
  if (fit.size() == 1) return fit.front();
  return fail(fit.empty() ? Errc::unavailable : Errc::bad_config,
              fmt::format("{}; {}; set projector.kms.connector to a connector or model",
                          sentence_of(fit.size(), wanted), list_of(displays)));
}

}  // namespace handcast::renderer::kms
