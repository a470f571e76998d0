// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace handcast {

/// How a process ended, by the status of waitpid(): "exit 3", "signal 11, Segmentation fault".
std::string describe_end(int wait_status);

}  // namespace handcast
