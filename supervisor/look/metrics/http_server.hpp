// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The first line of a request.
struct HttpRequest {
  std::string_view method;  ///< "GET"; "" if the request is not HTTP
  std::string_view path;    ///< without a query; "" if the request is not HTTP
};

/// The request at the start of `bytes`, to which its parts refer. Empty if its end has not arrived
/// yet.
std::optional<HttpRequest> parse_http_request(std::string_view bytes);

/// The answer to a request, with its header. `text` is called for the body of GET /metrics.
std::string http_answer(const HttpRequest& request, const std::function<std::string()>& text);

/// Serves a text at http://127.0.0.1:PORT/metrics, to this machine only, during the lifetime of the
/// object. One thread serves all connections. Each has a limited time for its request and as long
/// for its answer, and with kMostConnections of them the oldest one is closed for a new one: a
/// client that sends or reads slowly, or nothing at all, does not keep others waiting.
class HttpServer {
 public:
  static constexpr std::int64_t kPatience_ns = 2'000'000'000;  ///< for a request, for an answer
  static constexpr std::size_t kMostConnections = 64;          ///< open at the same time
  static constexpr std::size_t kLongestRequest = 16'384;       ///< bytes; longer ones are refused

  /// `text` is called for each request, on the thread of the server. Errors: unavailable (the port
  /// is in use or not permitted, or there is no thread).
  static Result<HttpServer> listen(int port, std::function<std::string()> text,
                                   std::int64_t patience_ns = kPatience_ns);
  /// The port; that of the kernel's choice if listen() was called with 0.
  int port() const;
  /// `other` serves nothing afterwards.
  HttpServer(HttpServer&& other) noexcept;
  ~HttpServer();

 private:
  class Loop;
  explicit HttpServer(std::unique_ptr<Loop> loop);
  std::unique_ptr<Loop> loop_;
};

}  // namespace handcast::supervisor
