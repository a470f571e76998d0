// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace handcast {

/// The version of this build, e.g. "0.1.0".
std::string_view version();

/// The features that this build lacks because a library was not found, one line each: "without
/// NAME: no SENTENCE". Empty if all features are built.
std::string_view absent_features();

}  // namespace handcast
