// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

/// Files of config/assets/leap, which are a part of the program.
namespace handcast::camera::leap {

extern const std::string_view kBringUp;  ///< bring_up.txt

}  // namespace handcast::camera::leap
