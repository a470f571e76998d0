// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/wait_status.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstring>

namespace handcast {

std::string describe_end(int wait_status) {
  if (WIFEXITED(wait_status)) return fmt::format("exit {}", WEXITSTATUS(wait_status));
  return fmt::format("signal {}, {}", WTERMSIG(wait_status), strsignal(WTERMSIG(wait_status)));
}

}  // namespace handcast
