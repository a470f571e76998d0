// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace handcast {

/// The version of this build: "0.1.0".
std::string_view version();

/// What this build lacks because a library was not found: "without NAME: no SENTENCE", a line each;
/// "" if it lacks nothing.
std::string_view absent_features();

}  // namespace handcast
