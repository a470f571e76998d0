// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/preview/options.hpp"

namespace handcast::preview {

/// Watches a rig for options.after_s and writes a picture. Errors: those of RigFeed, bad_config or
/// unavailable (the file cannot be written).
Result<void> shoot(const Options& options);

}  // namespace handcast::preview
