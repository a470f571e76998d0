// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace handcast::page {

/// Describes this machine: "AMD EPYC, 2 cores, Debian GNU/Linux 12 (bookworm)".
std::string this_machine();

}  // namespace handcast::page
