// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <poll.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

#include "supervisor/life/child.hpp"

namespace handcast::test {

/// Everything that a child writes until it ends, or until it has been silent for 30 s.
inline std::string output_of(const std::string& program,
                             const std::vector<std::string>& arguments) {
  auto child = supervisor::Child::spawn({.program = program, .arguments = arguments});
  if (!child) return child.error().what;
  std::string output;
  std::array<char, 4096> bytes;
  pollfd readable{.fd = child->log_fd(), .events = POLLIN, .revents = 0};
  while (poll(&readable, 1, 30'000) > 0) {
    const auto count = read(child->log_fd(), bytes.data(), bytes.size());
    if (count <= 0) break;
    output.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return output;
}

}  // namespace handcast::test
