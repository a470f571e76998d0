// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::log {

/// Sets a function that each sentence of the log passes before it is written. Call it once at
/// start-up, before other threads log.
void set_wording(std::string (*wording)(std::string_view sentence));

}  // namespace handcast::log
