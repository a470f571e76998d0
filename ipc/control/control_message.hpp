// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

/// What goes over a rig's control socket: a request and its answer, each one JSON object on a line.
///
///   {"verb":"status"}                                    {"ok":true,"status":{...}}
///   {"verb":"down"}                                      {"ok":true} when everything has stopped
///   {"verb":"restart","service":"pose"}                  {"ok":true,"pause_ms":3.1} when it is
///                                                        ready again; "pause_ms": how long its
///                                                        stream paused, if it has one
///   {"verb":"swap","service":"pose","backend":"replay"}  {"ok":true,"pause_ms":3.1} when the back
///                                                        end is ready
///   {"verb":"reload"}                                    {"ok":true,"restarted":["pose"],
///                                                        "pauses_ms":{"pose":3.1},...} when all
///                                                        are ready again
///   {"verb":"rings"}                                     {"ok":true,"rings":["camera.frames",...]}
///                                                        and their descriptors
///   {"verb":"history","seconds":10}                      {"ok":true} and the descriptor of a
///                                                        snapshot (record/history.hpp)
///   {"verb":"rig"}                                       {"ok":true,"rig":"...","file":"..."}: the
///                                                        rig as it runs, as TOML, all paths
///                                                        absolute; and the rig file
///
/// Descriptors come with the first byte of the answer (SCM_RIGHTS). The answer to what cannot be
/// done is {"ok":false,"error":"one sentence"}.
namespace handcast::control {

/// The most that the kernel passes on with one answer (SCM_MAX_FD).
inline constexpr std::size_t kMostDescriptors = 253;

/// What can be asked for; see the top of this file.
enum class Verb { status, down, restart, swap, reload, rings, history, rig };

/// What a rig is asked for.
struct Request {
  Verb verb = Verb::status;  ///< what
  std::string service;       ///< restart, swap
  std::string backend;       ///< swap
  double seconds = 0;        ///< history: how far back
};

/// A rig's answer, and the descriptors that come with it.
struct Answer {
  nlohmann::json object;              ///< the line that it came as
  std::vector<UniqueFd> descriptors;  ///< close-on-exec, in the order of the answer
};

/// The text at a key of an object; "" if there is none, as in the answer of another version.
std::string text_at(const nlohmann::json& object, const char* key);

/// Reads a request. Errors: bad_data, with a sentence that says what is wrong with the line.
Result<Request> parse_request(std::string_view line);
/// The reverse, without the newline.
std::string print_request(const Request& request);
/// A request or an answer as it goes over the socket, without the newline.
std::string to_line(const nlohmann::json& object);

/// {"ok":true}; more may be added.
nlohmann::json success();
/// {"ok":false} with the sentence.
nlohmann::json failure(std::string sentence);

}  // namespace handcast::control
