// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <poll.h>

#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/unique_fd.hpp"

namespace handcast::desk::osc {

/// Answers GET by HTTP/1.1, one request a connection, inside the loop of a thread that waits for
/// other things, too. Bounded: 16 connections, 4 KB a request, 2 s for a request and its answer, 50
/// answers a second. One thread.
class QueryServer {
 public:
  /// The JSON at "/path?attribute"; empty: there is none; "": it has no such attribute.
  using Answer = std::function<std::optional<std::string>(std::string_view query)>;

  /// `socket` listens and does not block; without one there are no connections.
  QueryServer(UniqueFd socket, Answer answer)
      : socket_(std::move(socket)), answer_(std::move(answer)) {}

  /// Adds what it waits for.
  void add_to(std::vector<pollfd>& waits) const;
  /// Goes on with all connections that can. True if a request waits for its answer: call it again
  /// soon.
  bool turn(std::int64_t now_ns);

 private:
  struct Connection {
    UniqueFd socket;
    std::int64_t until_ns = 0;
    std::string request, answer;
    std::size_t sent = 0;     ///< bytes of the answer
    bool is_waiting = false;  ///< the request is whole
  };
  void accept(std::int64_t now_ns);
  bool go_on(Connection& connection, std::int64_t now_ns);
  std::string answer_to(std::string_view request) const;

  UniqueFd socket_;
  Answer answer_;
  std::list<Connection> connections_;
  std::int64_t next_answer_ns_ = 0;
};

}  // namespace handcast::desk::osc
