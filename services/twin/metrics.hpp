#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ipc/msg/stage_mark.hpp"
#include "services/twin/twin.hpp"

namespace handcast::twin {

/// Gathers frame scores and stage times into the metrics of `simulate --json` and the observer: overall, per speed bin
/// (0-0.1, -0.3, -0.6, -1.0, >1 m/s) and per hand.
class Metrics {
 public:
  void add(const FrameScore& score);
  void add_stages(std::span<const msg::StageMark> stages);
  void add_foldovers(int count);
  /// Landings of a fixed set of surface points in successive frames; jitter is the RMS of what remains after the truth's own motion.
  void add_jitter(double square_px, int samples);

  /// {"frames","interior_mm":{mean,p95,p99},"interior_px":{...},"coverage","spill","iou","seam_px","jitter_px","foldovers",
  ///  "equivalent_latency_ms","frame_us":{p50,p99},"stage_us":{stage:{p50,p99}},"bins":{...},"hands":{"left":{...}}}
  nlohmann::json to_json() const;

 private:
  struct Bin {
    std::vector<float> px, mm;
    std::int64_t frames = 0, hand = 0, lit = 0, spill = 0, joined = 0;
    double seam = 0, lag = 0, speed2 = 0;
  };
  std::map<std::string, Bin> bins_;   ///< "all", "bin:<=0.1", "hand:left", ...
  std::map<std::uint32_t, std::vector<float>> stage_us_;
  std::int64_t foldovers_ = 0, frames_ = 0;
  double jitter_square_ = 0;
  std::int64_t jitter_samples_ = 0;
};

}  // namespace handcast::twin
