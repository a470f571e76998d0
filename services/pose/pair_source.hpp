// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "config/sections/handover.hpp"
#include "services/pose/pose_source.hpp"
#include "services/pose/source_runner.hpp"

namespace handcast::pose {

/// How a pair opens its sources, which are in the same tracker space.
struct PairParts {
  SourceRunner::Open first, second;
};

/// Opens two sources as one that hands over between them (Handover). One that is missing is opened
/// later; if both are, the error is that of the first. Errors: bad_config of either.
Result<std::unique_ptr<PoseSource>> open_pair(const config::Handover& settings, PairParts parts);

}  // namespace handcast::pose
