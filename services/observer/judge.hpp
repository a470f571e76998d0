// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/projection.hpp"

namespace handcast::observer {

/// Scores the live light against a ground truth. One thread.
class Judge {
 public:
  virtual ~Judge() = default;

  /// Scores one projected frame; frames must come in the order of their lit_ns.
  virtual void add(const msg::Projection& projection) = 0;
  /// True if no frame was added.
  virtual bool empty() const = 0;
  /// The metrics of the frames of the last one to two minutes: see twin::Metrics::to_json().
  virtual nlohmann::json scores() const = 0;
};

/// The judge that knows the true hand of the twin. `epoch_ns`: the epoch of the rig,
/// CLOCK_MONOTONIC. Errors: bad_config (the motion of the twin cannot be read).
Result<std::unique_ptr<Judge>> open_judge(const config::Rig& rig,
                                          const calib::Calibration& calibration,
                                          std::int64_t epoch_ns);

}  // namespace handcast::observer
