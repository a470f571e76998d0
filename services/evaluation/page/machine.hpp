// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace handcast::page {

/// This machine: processor, cores, system.
std::string this_machine();

}  // namespace handcast::page
