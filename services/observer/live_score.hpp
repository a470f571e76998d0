// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "services/evaluation/twin/metrics.hpp"

namespace handcast::observer {

/// The metrics of the last one to two minutes of scored frames, in bounded memory for a rig that
/// runs for days: two overlapping windows take turns; the older one is what is reported.
class LiveScore {
 public:
  explicit LiveScore(std::int64_t window_ns = 60'000'000'000) : window_ns_(window_ns) {}

  /// Frames come in the order of their lit_ns. Of the surface points of a hand at most 300 are
  /// kept, evenly chosen.
  void add(twin::FrameScore score, int foldovers);
  nlohmann::json to_json() const;
  bool empty() const { return frames_ == 0; }

 private:
  std::int64_t window_ns_;
  std::int64_t turn_ns_ = 0;  ///< when the windows last took turns
  std::int64_t frames_ = 0;
  twin::Metrics older_, newer_;
};

}  // namespace handcast::observer
