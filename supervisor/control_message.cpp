#include "supervisor/control_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/join.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::array<std::string_view, 4> kVerbs{"status", "down", "restart", "swap"};

std::string text_of(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

Result<Request> parse_request(std::string_view line) {
  const auto object = nlohmann::json::parse(line, nullptr, false);
  if (!object.is_object()) return fail(Errc::bad_data, "a request is one JSON object on a line");
  const auto name = text_of(object, "verb");
  const auto verb = std::ranges::find(kVerbs, name);
  if (verb == kVerbs.end()) return fail(Errc::bad_data, fmt::format("no verb '{}'; there are: {}", name, config::join(kVerbs, ", ")));

  Request request{static_cast<Verb>(verb - kVerbs.begin()), text_of(object, "service"), text_of(object, "backend")};
  if (request.service.empty() && (request.verb == Verb::restart || request.verb == Verb::swap))
    return fail(Errc::bad_data, fmt::format("{} needs \"service\"", name));
  if (request.backend.empty() && request.verb == Verb::swap) return fail(Errc::bad_data, "swap needs \"backend\"");
  return request;
}

std::string print_request(const Request& request) {
  nlohmann::json object{{"verb", kVerbs[static_cast<std::size_t>(request.verb)]}};
  if (!request.service.empty()) object["service"] = request.service;
  if (!request.backend.empty()) object["backend"] = request.backend;
  return object.dump();
}

nlohmann::json success() { return {{"ok", true}}; }
nlohmann::json failure(std::string sentence) { return {{"ok", false}, {"error", std::move(sentence)}}; }

}  // namespace handcast::supervisor
