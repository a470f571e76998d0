// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/control_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::control {
namespace {

constexpr std::array<std::string_view, 8> kVerbs{"status", "down",  "restart", "swap",
                                                 "reload", "rings", "history", "rig"};

double number_of(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0;
}

/// What the verb needs and the request does not have; "" if it is complete.
std::string_view lack_of(const Request& request) {
  const bool on_service = request.verb == Verb::restart || request.verb == Verb::swap;
  if (on_service && request.service.empty()) return "\"service\"";
  if (request.verb == Verb::swap && request.backend.empty()) return "\"backend\"";
  if (request.verb == Verb::history && !(request.seconds > 0))
    return "\"seconds\", a number above 0";
  return {};
}

}  // namespace

std::string text_at(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Result<Request> parse_request(std::string_view line) {
  const auto object = nlohmann::json::parse(line, nullptr, false);
  if (!object.is_object()) return fail(Errc::bad_data, "a request is one JSON object on a line");
  const auto name = text_at(object, "verb");
  const auto verb = std::ranges::find(kVerbs, name);
  if (verb == kVerbs.end())
    return fail(Errc::bad_data,
                fmt::format("no verb {}; there are: {}", quote(name), join(kVerbs, ", ")));

  const Request request{static_cast<Verb>(verb - kVerbs.begin()), text_at(object, "service"),
                        text_at(object, "backend"), number_of(object, "seconds")};
  if (const auto lack = lack_of(request); !lack.empty())
    return fail(Errc::bad_data, fmt::format("{} needs {}", name, lack));
  return request;
}

std::string print_request(const Request& request) {
  nlohmann::json object{{"verb", kVerbs[static_cast<std::size_t>(request.verb)]}};
  if (!request.service.empty()) object["service"] = request.service;
  if (!request.backend.empty()) object["backend"] = request.backend;
  if (request.seconds > 0) object["seconds"] = request.seconds;
  return to_line(object);
}

// Bytes that are no UTF-8, which a person may have typed, are replaced.
std::string to_line(const nlohmann::json& object) {
  return object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json success() { return {{"ok", true}}; }
nlohmann::json failure(std::string sentence) {
  return {{"ok", false}, {"error", std::move(sentence)}};
}

}  // namespace handcast::control
