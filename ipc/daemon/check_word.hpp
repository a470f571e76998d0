// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::daemon {

/// The last line of `handcast-NAME --check` if nothing is wrong. Exit 0 alone is no proof: a
/// library that the rig names may end the process while it is loaded.
inline constexpr const char* kCheckedWord = "checked\n";

}  // namespace handcast::daemon
