// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "services/lab/report/tables.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::report {
namespace {

using nlohmann::json;

std::string text_at(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) return "–";
  const auto& value = object.at(key);
  if (value.is_string())
    return value.get<std::string>().empty() ? "–" : page::escape(value.get<std::string>());
  return value.is_number() ? fmt::format("{}", value.get<double>()) : "–";
}

std::optional<double> rate_of(const Source& live, const std::string& service, const char* which) {
  return live.number(json::json_pointer("/rates") / service / std::string(which));
}

std::string held_share(const Source& live, const std::string& service) {
  const auto wanted_hz = rate_of(live, service, "wanted_hz"),
             held_hz = rate_of(live, service, "held_hz");
  if (!wanted_hz || !held_hz || *wanted_hz <= 0) return "–";
  return fmt::format("{:.0f} %", 100 * *held_hz / *wanted_hz);
}

/// The names of the services in the order of the data flow, then all others.
std::vector<std::string> names_in_order(const json& services) {
  std::vector<std::string> names;
  for (const char* name : {"camera", "pose", "landmarks", "projector", "observer"})
    if (services.contains(name)) names.push_back(name);
  for (const auto& service : services.items())
    if (std::find(names.begin(), names.end(), service.key()) == names.end())
      names.push_back(service.key());
  return names;
}

std::string services_table(const Source& live) {
  const json services = live.content->value("services", json::object());
  if (!services.is_object()) return "";
  std::string table =
      "<div class=\"wide\"><table>\n<thead><tr><th>service</th><th>back end</th><th>requested, "
      "Hz</th><th>measured, Hz</th><th>share</th>"
      "<th>restarts</th></tr></thead>\n<tbody>\n";
  for (const auto& name : names_in_order(services)) {
    const auto& service = services.at(name);
    table += fmt::format(
        "<tr><th "
        "scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        page::escape(name), text_at(service, "backend"),
        page::figure(rate_of(live, name, "wanted_hz"), 1),
        page::figure(rate_of(live, name, "held_hz"), 1), held_share(live, name),
        text_at(service, "restarts"));
  }
  return table + "</tbody></table></div>\n";
}

/// That the computer was too slow for the rates; "" if it was not.
std::string slowness(const Source& live) {
  constexpr double kEnough = 0.9;
  double least = 1;
  for (const auto* service : {"camera", "projector"}) {
    const auto wanted_hz = rate_of(live, service, "wanted_hz"),
               held_hz = rate_of(live, service, "held_hz");
    const auto judged =
        json::json_pointer("/services") / std::string(service) / std::string("is_held_to_its_rate");
    const bool is_judged = !live.content->contains(judged) || live.content->at(judged) != false;
    if (is_judged && wanted_hz && held_hz && *wanted_hz > 0)
      least = std::min(least, *held_hz / *wanted_hz);
  }
  if (least >= kEnough) return "";
  return fmt::format(
      "<p>This computer was too slow for the requested rates and held {:.0f} % of one of them. "
      "Light that comes late falls beside its place, so the figures of the live rig are worse than "
      "those of the simulation, which assumes the full rates.</p>\n",
      100 * least);
}

std::string score_sentence(const Source& observer) {
  if (!observer.content)
    return page::missing(fmt::format("The live light was not scored: {}.", observer.problem));
  const auto percent = [&](const char* pointer) {
    const auto share = observer.number(pointer);
    return page::figure(share ? std::optional(*share * 100) : std::nullopt, 1);
  };
  return fmt::format(
      "<p>The observer compared {} frames of the live light with the truth of the twin: interior "
      "error <b>{} mm</b> mean, <b>{} mm</b> p95; "
      "<b>{} %</b> of the hand lit, {} % spill.</p>\n",
      page::figure(observer.number("/frames"), 0),
      page::figure(observer.number("/interior_mm/mean"), 2),
      page::figure(observer.number("/interior_mm/p95"), 2), percent("/coverage"),
      percent("/spill"));
}

}  // namespace

std::string live_table(const Inputs& inputs) {
  const auto& live = inputs.live;
  if (!live.content)
    return page::missing(fmt::format("There was no live run: {}.", live.problem)) +
           (inputs.observer.content ? score_sentence(inputs.observer) : "");
  return fmt::format("<p>The rig <b>{}</b> ran live for {} s, with one process per service.</p>\n",
                     text_at(*live.content, "rig"), page::figure(live.number("/seconds"), 1)) +
         services_table(live) + slowness(live) + score_sentence(inputs.observer);
}

}  // namespace handcast::report
