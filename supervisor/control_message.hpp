#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"

/// What goes over a rig's control socket: one JSON object a line, a request and its answer.
///   {"verb":"status"}                                      → {"ok":true,"status":{…}}
///   {"verb":"down"}                                        → {"ok":true}, when everything has stopped
///   {"verb":"restart","service":"pose"}                    → {"ok":true}, when it is ready again
///   {"verb":"swap","service":"pose","backend":"replay"}    → {"ok":true}, when the new back end is ready
/// What cannot be done: {"ok":false,"error":"one sentence"}.
namespace handcast::supervisor {

enum class Verb { status, down, restart, swap };

struct Request {
  Verb verb = Verb::status;
  std::string service;  ///< restart, swap
  std::string backend;  ///< swap
};

/// Errors: bad_data with a sentence that says what is wrong with the line.
Result<Request> parse_request(std::string_view line);
std::string print_request(const Request& request);

nlohmann::json success();
nlohmann::json failure(std::string sentence);

}  // namespace handcast::supervisor
