// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/attached.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ipc/base/quote.hpp"

namespace handcast::daemon {

using Json = nlohmann::ordered_json;  // settings stay in their order

static void to_json(Json& object, const Mode& mode) {
  object = {{"format", mode.format},
            {"least_width_px", mode.least_width_px},
            {"least_height_px", mode.least_height_px},
            {"width_px", mode.width_px},
            {"height_px", mode.height_px},
            {"rate_hz", mode.rate_hz}};
}

static void from_json(const Json& object, Mode& mode) {
  object.at("format").get_to(mode.format);
  object.at("least_width_px").get_to(mode.least_width_px);
  object.at("least_height_px").get_to(mode.least_height_px);
  object.at("width_px").get_to(mode.width_px);
  object.at("height_px").get_to(mode.height_px);
  object.at("rate_hz").get_to(mode.rate_hz);
}

static void to_json(Json& object, const Attached& device) {
  auto settings = Json::object();
  for (const auto& [setting, value] : device.settings) settings[setting] = value;
  object = {{"kind", kKindNames[static_cast<std::size_t>(device.kind)]},
            {"name", device.name},
            {"about", device.about},
            {"settings", settings},
            {"trouble", device.trouble},
            {"names", device.names},
            {"modes", device.modes},
            {"is_operators", device.is_operators}};
}

static void from_json(const Json& object, Attached& device) {
  const auto kind = std::ranges::find(kKindNames, object.at("kind").get<std::string>());
  if (kind == kKindNames.end())
    throw Json::other_error::create(501, "'kind' is no kind of device", &object);
  device.kind = static_cast<Kind>(kind - kKindNames.begin());
  for (const auto& [setting, value] : object.at("settings").items())
    device.settings.emplace_back(setting, value.get<std::string>());
  object.at("name").get_to(device.name);
  object.at("about").get_to(device.about);
  object.at("trouble").get_to(device.trouble);
  object.at("names").get_to(device.names);
  object.at("modes").get_to(device.modes);
  object.at("is_operators").get_to(device.is_operators);
}

std::string to_json(const std::vector<Attached>& attached) {
  // A device may call itself anything.
  return Json(attached).dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Result<std::vector<Attached>> attached_from(std::string_view json) try {
  return Json::parse(json).get<std::vector<Attached>>();
} catch (const Json::exception& problem) {
  return fail(Errc::bad_data,
              fmt::format("not a list of devices: {}", shown_line(problem.what(), 200)));
}

}  // namespace handcast::daemon
