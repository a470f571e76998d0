// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/monitor.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <vector>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::renderer {
namespace {

std::string list_of(std::span<const Monitor> monitors) {
  if (monitors.empty()) return "no monitor is connected";
  std::vector<std::string> texts;
  texts.reserve(monitors.size());
  for (std::size_t i = 0; i < monitors.size(); ++i) texts.push_back(describe(monitors[i], i));
  return "connected are " + join(texts, ", ");
}

std::optional<std::size_t> index_in(std::string_view text) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return index;
}

}  // namespace

std::string describe(const Monitor& monitor, std::size_t index) {
  return fmt::format("{}: '{}' ({}{}x{}, {:.4g} Hz{})", index, monitor.output,
                     monitor.model.empty() ? "" : monitor.model + ", ", monitor.width_px,
                     monitor.height_px, monitor.rate_hz,
                     monitor.is_primary ? ", the primary one" : "");
}

Result<std::size_t> choose_monitor(std::span<const Monitor> monitors, std::string_view wanted) {
  std::vector<std::size_t> fit;
  for (std::size_t i = 0; i < monitors.size(); ++i)
    if (wanted.empty() ? !monitors[i].is_primary
                       : wanted == monitors[i].output || wanted == monitors[i].model)
      fit.push_back(i);
  if (const auto index = index_in(wanted); fit.empty() && index && *index < monitors.size())
    fit.push_back(*index);
  if (fit.size() == 1) return fit.front();

  const auto sentence =
      fit.empty() ? (wanted.empty() ? std::string("there is no monitor besides the primary one")
                                    : "there is no monitor " + quote(wanted))
                  : (wanted.empty() ? std::string("several monitors are possible")
                                    : "several monitors are called " + quote(wanted));
  return fail(fit.empty() ? Errc::unavailable : Errc::bad_config,
              fmt::format("{}; {}; set projector.window.monitor to the output, model or index of "
                          "one",
                          sentence, list_of(monitors)));
}

}  // namespace handcast::renderer
