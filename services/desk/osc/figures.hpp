// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>

namespace handcast::desk::osc {

/// The figures of a rig (`handcast status --json`) as a bundle: /rate/camera/frames ,f (Hz, of each
/// ring), /service/camera ,s (its state), /time/draw ,ff (p50 and p99 of each stage, ms),
/// /error/missed_refreshes ,i, /error/lost_images ,i, /error/tracker_faults ,i, and
/// /error/drift_mm ,f, if the calibration is watched. What is missing is left out.
std::string write_figures(const nlohmann::json& status);

/// Asks a rig for its figures, once a second, by a thread of its own at low priority.
class FigureFeed {
 public:
  explicit FigureFeed(std::string rig);
  /// The newest bundle, once; "" if there is none. Never blocks.
  std::string take();

 private:
  void run(const std::stop_token& stop);

  std::string rig_;
  std::mutex mutex_;
  std::string bundle_;
  std::jthread thread_;
};

}  // namespace handcast::desk::osc
