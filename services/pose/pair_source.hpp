// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "config/sections/handover.hpp"
#include "services/pose/pose_source.hpp"
#include "services/pose/source_runner.hpp"

namespace handcast::pose {

/// The sources of a pair, which are in the same tracker space.
struct PairParts {
  PairPart first, second;
  Patience patience;
  /// How long the start waits for a source while the other one is open.
  std::int64_t start_ns = 3'000'000'000;
  /// So long after a source began to hang, and only while no hand is in sight, the service ends to
  /// be started anew.
  std::int64_t restart_ns = 60'000'000'000;
};

/// Opens two sources as one that hands over between them (Handover). One that is missing is opened
/// later; if both are, the error is that of the first. One that hangs is replaced by the other one.
/// Errors: bad_config of either. sample() returns unavailable if a source hangs and only a new
/// process helps: if the other one is silent, too, or see PairParts::restart_ns.
Result<std::unique_ptr<PoseSource>> open_pair(const config::Handover& settings, PairParts parts);

}  // namespace handcast::pose
