// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstddef>
#include <stop_token>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::projegraphy {

/// A request to a server.
struct Request {
  std::string url;                        ///< http or https
  std::string body;                       ///< of a POST; empty: a GET
  std::string type = "application/json";  ///< of the body
  std::string key;  ///< for "Authorization: Bearer"; empty: none. It is in no sentence.
  std::chrono::milliseconds patience{8000};  ///< for all of it
  std::size_t most_bytes = 1 << 20;          ///< of the reply
};

/// Sends it and returns the body of a reply with the status 200. Redirections are not followed.
/// Errors: timeout; unavailable (no server, or it is busy: 408, 429, 5xx), which may go away;
/// bad_config (the address, 401, 403, 404) and bad_data (another status, a reply that is too
/// large), which do not; sentences name the host only.
Result<std::string> fetch(const Request& request, const std::stop_token& stop);

/// The host of an address, for sentences: without names, keys and paths. "" if it has none.
std::string host_of(const std::string& url);

}  // namespace handcast::projegraphy
