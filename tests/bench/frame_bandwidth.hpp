// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/frame_pipeline.hpp"

namespace handcast::bench {

/// Prints, for the passes of the painter, the bytes that they must read and write at least, the
/// speed of a plain copy of as many bytes in this run, the time that follows from both, and the
/// measured one. Returns the last two as a ratio, by pass; nothing if it was not measured.
std::vector<std::pair<std::string, double>> print_bandwidth(const FrameTimes& times);

}  // namespace handcast::bench
