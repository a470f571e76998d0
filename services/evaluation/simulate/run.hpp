// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/base/result.hpp"
#include "services/evaluation/simulate/options.hpp"

namespace handcast::simulate {

/// The whole of `handcast simulate`: runs the rig and writes what the options ask for.
Result<void> run(const Options& options);

}  // namespace handcast::simulate
