// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "tests/bench/goals.hpp"

namespace handcast::bench {

/// The parts of bench_devices. Each prints a table and adds its goals.
/// @{
void measure_hid(std::vector<Goal>& goals);
/// @}

}  // namespace handcast::bench
