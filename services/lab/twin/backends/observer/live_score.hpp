// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "services/lab/twin/metrics.hpp"

namespace handcast::observer {

/// The metrics of the scored frames of the last one to two windows of time. Memory is bounded, so a
/// rig can run for days: of two overlapping windows the older one is reported, and the newer one
/// replaces it when it is full. One thread.
class LiveScore {
 public:
  /// `window_ns`: the length of a window; one minute by default.
  explicit LiveScore(std::int64_t window_ns = 60'000'000'000) : window_ns_(window_ns) {}

  /// Adds a frame; frames must come in the order of their display_ns. At most 300 surface points of
  /// each hand are kept, evenly chosen.
  void add(twin::FrameScore score, int foldovers);
  /// The metrics of the older window: see twin::Metrics::to_json().
  nlohmann::json to_json() const;
  /// True if no frame was added.
  bool empty() const { return frames_ == 0; }

 private:
  std::int64_t window_ns_;
  std::int64_t turn_ns_ = 0;  ///< display_ns of the first frame of the newer window
  std::int64_t frames_ = 0;
  twin::Metrics older_, newer_;
};

}  // namespace handcast::observer
