// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::desk {

/// A request that came whole.
struct HttpRequest {
  std::string method, path;                    ///< "GET", "/api/set"; without the query
  std::map<std::string, std::string> headers;  ///< by their names in lower case
  std::string body;                            ///< at most HttpLimits::body_bytes
  std::string peer;                            ///< the address of the client
  std::string local;          ///< the address and port of this computer that it came to
  bool is_encrypted = false;  ///< the server has a certificate

  /// The value of a header; "" if there is none.
  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

/// An answer that goes on for as long as the client listens.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Appends what is to be sent next; waits for it for 1 s at most. False: the stream is over.
  virtual bool read(std::string& bytes) = 0;
};

/// An answer to a request.
struct HttpAnswer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
  std::unique_ptr<ByteStream> stream;  ///< in place of the body
};

/// What a client may ask of a server.
struct HttpLimits {
  unsigned connections = 64;                ///< at a time; others are closed at once
  std::size_t header_bytes = 16 << 10;      ///< of a request; a larger one gets 431
  std::size_t body_bytes = 64 << 10;        ///< of a request; a larger one gets 413
  std::int64_t request_ns = 5'000'000'000;  ///< until a request has come whole
  std::int64_t answer_ns = 20'000'000'000;  ///< until an answer, but a stream, was taken
  /// One client may connect so often at once, and so often a second from then on; more is closed
  /// before it costs a thread.
  /// @{
  double connections_at_once = 500, connections_hz = 200;
  /// @}
  unsigned stall_s = 10;  ///< a client that takes nothing for so long is left
};

/// PEM texts of a server that encrypts; empty: it does not.
struct TlsKeys {
  std::string certificate, key;
};

/// Serves HTTP/1.1 at one address, one request a connection, each in a thread of its own at low
/// priority: where cores are short, the page is late rather than the light.
class HttpServer {
 public:
  /// Any thread, several at once.
  using Handler = std::function<HttpAnswer(const HttpRequest&)>;

  /// `port` 0: any that is free. Errors: bad_config (not an address), unavailable (the port is
  /// taken, or no threads).
  static Result<std::unique_ptr<HttpServer>> open(const std::string& address, std::uint16_t port,
                                                  Handler handler, HttpLimits limits = {},
                                                  TlsKeys tls = {});
  /// Closes all connections and waits for the handlers.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::uint16_t port() const;

 private:
  struct Impl;
  explicit HttpServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace handcast::desk
