// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/display.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::renderer::kms {
namespace {

/// "60" means the mode of 59.94 Hz, too.
constexpr double kNearby_hz = 0.6;

struct Wish {
  int width_px = 0, height_px = 0;
  double rate_hz = 0;
  bool rate_is_wanted = false;
};

std::optional<Wish> parse(std::string_view wanted, const Mode& projector) {
  if (wanted.empty()) return Wish{projector.width_px, projector.height_px, projector.rate_hz};
  const std::string text(wanted);
  Wish wish{.rate_hz = projector.rate_hz};
  int end = -1;
  std::sscanf(text.c_str(), "%dx%d%n", &wish.width_px, &wish.height_px, &end);
  if (end == static_cast<int>(text.size())) return wish;
  wish.rate_is_wanted = true;
  end = -1;
  std::sscanf(text.c_str(), "%dx%d@%lf%n", &wish.width_px, &wish.height_px, &wish.rate_hz, &end);
  return end == static_cast<int>(text.size()) ? std::optional(wish) : std::nullopt;
}

std::string list_of(std::span<const Mode> modes) {
  if (modes.empty()) return "it lists no mode";
  std::vector<std::string> texts;
  texts.reserve(modes.size());
  for (const auto& mode : modes) texts.push_back(describe(mode));
  return "it has " + join(texts, ", ");
}

}  // namespace

Mode mode_of(const drmModeModeInfo& timing) {
  const double pixels = static_cast<double>(timing.htotal) * timing.vtotal *
                        ((timing.flags & DRM_MODE_FLAG_DBLSCAN) != 0 ? 2 : 1) *
                        (timing.vscan > 1 ? timing.vscan : 1);
  return {timing.hdisplay, timing.vdisplay, pixels > 0 ? 1e3 * timing.clock / pixels : 0, timing};
}

std::string describe(const Mode& mode) {
  return fmt::format("{}x{}@{:.4g}", mode.width_px, mode.height_px, mode.rate_hz);
}

Result<std::size_t> choose_mode(std::span<const Mode> modes, std::string_view wanted,
                                const Mode& projector) {
  const auto wish = parse(wanted, projector);
  if (!wish)
    return fail(Errc::bad_config,
                fmt::format("projector.kms.mode is '{}', not WIDTHxHEIGHT or WIDTHxHEIGHT@HZ; {}",
                            wanted, list_of(modes)));
  const auto distance_hz = [&](const Mode& mode) { return std::abs(mode.rate_hz - wish->rate_hz); };
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (modes[i].width_px != wish->width_px || modes[i].height_px != wish->height_px) continue;
    if (wish->rate_is_wanted && distance_hz(modes[i]) > kNearby_hz) continue;
    if (!best || distance_hz(modes[i]) < distance_hz(modes[*best])) best = i;
  }
  if (best) return *best;
  return fail(Errc::unavailable,
              fmt::format("there is no mode {}; {}; set projector.kms.mode to one of them",
                          wanted.empty() ? fmt::format("{}x{}, the size in the calibration",
                                                       wish->width_px, wish->height_px)
                                         : std::string(wanted),
                          list_of(modes)));
}

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
                          : "several displays are called " + quote(wanted);
  return wanted.empty() ? "no display is connected" : "there is no display " + quote(wanted);
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
