// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "ipc/base/statistics.hpp"
#include "services/lab/perception/viewer.hpp"

namespace handcast::twin {
namespace {

constexpr float kFar_mm = 10;  ///< light that is farther off is on another part of a finger
constexpr std::array<double, 4> kSpeedSteps_m_s{0.1, 0.3, 0.6, 1.0};
constexpr std::array<const char*, 5> kSpeedNames{"0-0.1", "0.1-0.3", "0.3-0.6", "0.6-1.0", ">1.0"};
constexpr std::array<const char*, 2> kSideNames{"left", "right"};

nlohmann::json ratio(double part, double whole) {
  return whole > 0 ? nlohmann::json(part / whole) : nlohmann::json();
}

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

}  // namespace

void Metrics::Bin::add(const FrameScore::Hand& hand) {
  ++frames;
  for (const float error : hand.interior_px) px.add(error);
  for (const float error : hand.missing_px) {
    px.add(error);
    mm.add(FrameScore::kMissing_mm);
  }
  for (const float error : hand.interior_mm) {
    mm.add(error);
    lit_mm.add(error);
    far_points += error > kFar_mm;
  }
  lit_points += static_cast<std::int64_t>(hand.interior_px.size());
  missing_points += static_cast<std::int64_t>(hand.missing_px.size());
  hand_px += hand.hand_px;
  lit_px += hand.lit_px;
  spill_px += hand.spill_px;
  union_px += hand.union_px;
  seam_px += hand.seam_px;
  lag_px_s += hand.lag_px_s;
  speed2_px_s2 += hand.speed2_px_s2;
  error2_px2 += hand.error2_px2;
}

void Metrics::write_spread(nlohmann::json& json, const Samples& samples, bool with_mean) {
  json = nlohmann::json::object();
  if (with_mean) json["mean"] = samples.empty() ? nlohmann::json() : nlohmann::json(samples.mean());
  if (!with_mean)
    json["p50"] = samples.empty() ? nlohmann::json() : nlohmann::json(samples.percentile(0.5));
  if (with_mean)
    json["p95"] = samples.empty() ? nlohmann::json() : nlohmann::json(samples.percentile(0.95));
  json["p99"] = samples.empty() ? nlohmann::json() : nlohmann::json(samples.percentile(0.99));
}

/// RMS of the error that no delay explains: what remains of it after the one that explains most.
nlohmann::json Metrics::Bin::residual_px() const {
  if (lit_points == 0) return {};
  const double explained = speed2_px_s2 > 0 ? lag_px_s * lag_px_s / speed2_px_s2 : 0;
  return std::sqrt(std::max(error2_px2 - explained, 0.0) / static_cast<double>(lit_points));
}

void Metrics::Bin::write(nlohmann::json& json) const {
  json["frames"] = frames;
  write_spread(json["interior_px"], px, true);
  write_spread(json["interior_mm"], mm, true);
  write_spread(json["lit_mm"], lit_mm, true);
  json["missing"] = ratio(double(missing_points), double(lit_points + missing_points));
  json["off_10mm"] =
      ratio(double(far_points + missing_points), double(lit_points + missing_points));
  json["coverage"] = ratio(double(lit_px), double(hand_px));
  json["spill"] = ratio(double(spill_px), double(hand_px));
  json["iou"] = ratio(double(lit_px), double(union_px));
  json["seam_px"] = ratio(seam_px, double(frames));
  json["equivalent_latency_ms"] = ratio(1e3 * lag_px_s, speed2_px_s2);
  json["residual_px"] = residual_px();
}

void Metrics::add(const FrameScore& score) {
  ++frames_;
  all_.spill_px += score.stray_px;
  all_.union_px += score.stray_px;
  for (const auto& hand : score.hands) {
    const auto speed =
        std::lower_bound(kSpeedSteps_m_s.begin(), kSpeedSteps_m_s.end(), hand.speed_m_s) -
        kSpeedSteps_m_s.begin();
    all_.add(hand);
    speed_m_s_.add(static_cast<float>(hand.speed_m_s));
    outline_px_ += hand.outline_px;
    by_speed_[static_cast<std::size_t>(speed)].add(hand);
    by_side_[static_cast<std::size_t>(hand.side)].add(hand);
  }
}

void Metrics::add_stages(std::span<const msg::StageMark> stages) {
  for (const auto& mark : stages)
    stage_us_[mark.stage].add(
        static_cast<float>(static_cast<double>(mark.end_ns - mark.begin_ns) * 1e-3));
}

void Metrics::add_foldovers(int count) { foldovers_ += count; }

void Metrics::add_rung(msg::Rung rung) { ++rungs_[static_cast<std::size_t>(rung)]; }

void Metrics::set_jitter(std::optional<double> light_px, std::optional<double> landmarks_px) {
  jitter_px_ = light_px;
  landmark_jitter_px_ = landmarks_px;
}

void Metrics::add_landmark(double error_px, double error_mm) {
  landmark_px_.add(static_cast<float>(error_px));
  landmark_mm_.add(static_cast<float>(error_mm));
}

/// What people would notice, by the model of a viewer. Light that is late without a fill ends
/// inside the hand along half of its outline: that counts as all edges.
void Metrics::write_perception(nlohmann::json& json) const {
  std::vector<double> speeds_deg_s;
  for (const float speed : speed_m_s_.kept())
    speeds_deg_s.push_back(perception::degrees_per_s(speed));
  const double edges = outline_px_ > 0 ? std::min(1.0, 2 * all_.seam_px / outline_px_) : 0;
  const double jnd_ms = perception::jnd_ms(speeds_deg_s, {.edges = edges});
  const bool is_seen = std::isfinite(jnd_ms) && all_.speed2_px_s2 > 0;
  const double latency_ms = 1e3 * all_.lag_px_s / std::max(all_.speed2_px_s2, 1e-9);
  json["jnd_ms"] = is_seen ? nlohmann::json(jnd_ms) : nlohmann::json();
  json["late_jnds"] = is_seen ? nlohmann::json(std::abs(latency_ms) / jnd_ms) : nlohmann::json();
}

nlohmann::json Metrics::to_json() const {
  nlohmann::json json;
  all_.write(json);
  json["frames"] = frames_;
  write_perception(json);
  json["jitter_px"] = or_null(jitter_px_);
  json["landmark_jitter_px"] = or_null(landmark_jitter_px_);
  json["foldovers"] = foldovers_;
  write_spread(json["landmark_px"], landmark_px_, true);
  write_spread(json["landmark_mm"], landmark_mm_, true);

  const auto hands = std::accumulate(rungs_.begin(), rungs_.end(), std::int64_t{0});
  for (std::size_t r = 0; r < msg::kRungs; ++r)
    json["rungs"][std::string(msg::kRungNames[r])] = ratio(double(rungs_[r]), double(hands));

  const auto frame = stage_us_.find(msg::Stage::frame);
  write_spread(json["frame_us"], frame == stage_us_.end() ? Samples() : frame->second, false);
  json["stage_us"] = nlohmann::json::object();
  for (const auto& [stage, spent] : stage_us_) {
    if (stage < msg::Stage::count)
      write_spread(json["stage_us"][std::string(msg::kStageNames[static_cast<std::size_t>(stage)])],
                   spent, false);
  }
  for (std::size_t b = 0; b < by_speed_.size(); ++b)
    by_speed_[b].write(json["bins"][kSpeedNames[b]]);
  for (std::size_t s = 0; s < by_side_.size(); ++s) by_side_[s].write(json["hands"][kSideNames[s]]);
  return json;
}

}  // namespace handcast::twin
