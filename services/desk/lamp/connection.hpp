// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stop_token>
#include <string>
#include <string_view>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::desk::lamp {

/// A TCP connection that carries lines which end with a carriage return. One thread. Errors:
/// timeout, unavailable (nobody is there), disconnected, bad_data (a line of more than 256 bytes),
/// bad_config (no such host).
class Connection {
 public:
  static Result<Connection> open(const std::string& host, const std::string& port,
                                 Deadline deadline, std::stop_token stop);
  Result<void> write(std::string_view line);
  /// The next line, without its end.
  Result<std::string> read();

 private:
  Connection(UniqueFd socket, std::string name, Deadline deadline, std::stop_token stop);
  Result<void> await(short events) const;

  UniqueFd socket_;
  std::string name_;  ///< for sentences
  Deadline deadline_;
  std::stop_token stop_;
  std::string left_;  ///< what came behind the last line
};

}  // namespace handcast::desk::lamp
