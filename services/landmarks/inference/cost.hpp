// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "ipc/base/result.hpp"

namespace handcast::landmarks {

/// The multiplications of a network's convolutions and matrix products by weights, in millions.
/// Errors: as of open_network("onednn").
Result<double> network_mmac(const std::filesystem::path& file);

}  // namespace handcast::landmarks
