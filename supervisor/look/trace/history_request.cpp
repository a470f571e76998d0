// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/trace/history_request.hpp"

#include <fmt/format.h>

#include "ipc/control/control_client.hpp"
#include "supervisor/look/figures/figures.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {

Result<HistorySnapshot> ask_for_history(const std::string& rig, double seconds) {
  control::Request request{.verb = control::Verb::history};
  request.seconds = seconds;
  auto answer = control::ask_with_descriptors(rig, request);
  if (!answer) return tl::make_unexpected(answer.error());
  if (answer->descriptors.size() != 1)
    return fail(Errc::bad_data, fmt::format("the answer of rig '{}' contains no history", rig));
  return read_history(answer->descriptors.front());
}

Result<std::map<std::string, double>> ask_for_rates(const std::string& rig) {
  const auto answer = control::ask(rig, control::Request{.verb = control::Verb::status});
  if (!answer) return tl::make_unexpected(answer.error());
  std::map<std::string, double> rates;
  const auto figures = figures_in(answer->value("status", nlohmann::json()));
  config::Rig any;
  any.camera2.backend = any.projector2.backend = "twin";
  for (const auto& service : services_of(any, {})) {
    const auto stream = figures.streams.find(service.stream);
    if (stream != figures.streams.end() && stream->second.wanted_hz)
      rates[service.name] = *stream->second.wanted_hz;
  }
  return rates;
}

}  // namespace handcast::supervisor
