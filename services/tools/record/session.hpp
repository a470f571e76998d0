// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/record/options.hpp"

namespace handcast::record {

/// Records a rig as the command line says, with a line of progress on a terminal and a table at the
/// end. Errors: unavailable (no rig is up; the disk is full), bad_config (the folder or a ring
/// cannot be taken), those of write_npy_folder().
Result<void> record(const Options& options);

}  // namespace handcast::record
