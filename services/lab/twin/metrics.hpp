// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "ipc/msg/rung.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "services/lab/twin/samples.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::twin {

/// Accumulates frame scores and stage times into the metrics of `simulate --json` and the observer:
/// overall, per speed bin (0-0.1, -0.3, -0.6, -1.0, >1 m/s) and per hand. `docs/method.md#metrics`
/// defines them.
class Metrics {
 public:
  /// Adds the score of one frame; a hand counts in the bin of its mean speed.
  void add(const FrameScore& score);
  /// Adds the durations of the stages of one frame.
  void add_stages(std::span<const msg::StageMark> stages);
  /// Adds the number of folded-over triangles or grid cells of one frame.
  void add_foldovers(int count);
  /// Adds the rung of one hand of one drawn frame.
  void add_rung(msg::Rung rung);
  /// RMS of the trembling on slow hands in 1-30 Hz: of the light (projector px) and of the
  /// corrected landmarks (camera px).
  void set_jitter(std::optional<double> light_px, std::optional<double> landmarks_px);
  /// Adds the distance between one corrected landmark and the true one at photon time: undistorted
  /// camera px, and mm at the landmark's distance.
  void add_landmark(double error_px, double error_mm);

  /// The metrics so far. A value that was not measured is null; all bins and both hands are
  /// present.
  ///
  ///     {"frames",
  ///      "interior_mm": {mean, p95, p99}, "interior_px": {...}, "lit_mm": {...},
  ///      "missing", "off_10mm", "coverage", "spill", "iou", "seam_px",
  ///      "equivalent_latency_ms", "residual_px",
  ///      "jnd_ms": the delay that people notice, "late_jnds": the latency relative to it,
  ///      "jitter_px", "landmark_jitter_px", "foldovers",
  ///      "landmark_px": {mean, p95, p99}, "landmark_mm": {...},
  ///      "rungs": {rung: share of the hands of drawn frames},
  ///      "frame_us": {p50, p99}, "stage_us": {stage: {p50, p99}},
  ///      "bins": {...}, "hands": {"left": {...}, "right": {...}}}
  /// "off_10mm" is the share of the visible skin that is dark or whose light is more than 10 mm
  /// off.
  nlohmann::json to_json() const;

 private:
  struct Bin {
    Samples px, mm, lit_mm;
    std::int64_t frames = 0, hand_px = 0, lit_px = 0, spill_px = 0, union_px = 0;
    std::int64_t lit_points = 0, far_points = 0, missing_points = 0;
    double seam_px = 0, lag_px_s = 0, speed2_px_s2 = 0, error2_px2 = 0;

    void add(const FrameScore::Hand& hand);
    void write(nlohmann::json& json) const;
    nlohmann::json residual_px() const;
  };
  void write_perception(nlohmann::json& json) const;
  static void write_spread(nlohmann::json& json, const Samples& samples, bool with_mean);

  Bin all_;
  std::array<Bin, 5> by_speed_;
  std::array<Bin, 2> by_side_;
  std::map<msg::Stage, Samples> stage_us_;
  Samples landmark_px_, landmark_mm_;
  Samples speed_m_s_;  ///< of hands
  double outline_px_ = 0;
  std::int64_t foldovers_ = 0, frames_ = 0;
  std::array<std::int64_t, msg::kRungs> rungs_{};  ///< hands of drawn frames
  std::optional<double> jitter_px_, landmark_jitter_px_;
};

}  // namespace handcast::twin
