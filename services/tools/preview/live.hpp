// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/preview/options.hpp"

namespace handcast::preview {

/// Shows a rig in a window until the user ends it, also if the rig goes down and comes up again.
/// Call it on the main thread. Errors: those of RigFeed::open(), unavailable (no display, or no
/// OpenGL).
Result<void> show_live(const Options& options);

}  // namespace handcast::preview
