// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "ipc/base/result.hpp"

namespace handcast::landmarks {

/// The multiplications with weights in a network's convolutions and matrix products, in millions.
/// Errors: those of open_network().
Result<double> network_mmac(const std::filesystem::path& file);

}  // namespace handcast::landmarks
