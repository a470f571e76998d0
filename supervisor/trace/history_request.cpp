#include "supervisor/trace/history_request.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "supervisor/control/control_client.hpp"
#include "supervisor/life/streams.hpp"

namespace handcast::supervisor {

Result<HistorySnapshot> ask_for_history(const std::string& rig, double seconds) {
  Request request{.verb = Verb::history};
  request.seconds = seconds;
  auto answer = ask_with_descriptors(rig, request);
  if (!answer) return tl::make_unexpected(answer.error());
  if (answer->descriptors.size() != 1) return fail(Errc::bad_data, fmt::format("rig '{}' gave no history", rig));
  return read_history(answer->descriptors.front());
}

Result<std::map<std::string, double>> ask_for_rates(const std::string& rig) {
  const auto answer = ask(rig, Request{.verb = Verb::status});
  if (!answer) return tl::make_unexpected(answer.error());
  std::map<std::string, double> rates;
  for (const auto& service : services_of({})) {
    const nlohmann::json::json_pointer place("/status/rings/" + service.stream + "/asked_hz");
    if (!service.stream.empty() && answer->contains(place) && answer->at(place).is_number())
      rates[service.name] = answer->at(place).get<double>();
  }
  return rates;
}

Result<double> parse_seconds(const std::string& text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  if (whole && std::isfinite(seconds) && seconds > 0) return seconds;
  return fail(Errc::bad_data, fmt::format("--seconds {}: expected a time above 0", text));
}

}  // namespace handcast::supervisor
