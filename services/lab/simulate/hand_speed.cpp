// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/hand_speed.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"

namespace handcast::simulate {
namespace {

/// No speed is computed over a longer gap, in which the hand was away; two refreshes of a projector
/// of 60 Hz are closer.
constexpr double kGap_s = 0.05;

}  // namespace

double HandSpeed::add(msg::Side side, const std::array<glm::dvec3, msg::kLandmarks>& landmarks_m,
                      std::int64_t display_ns) {
  auto& trail = trails_[static_cast<std::size_t>(side)];
  const double elapsed_s = ns_to_seconds(display_ns - trail.display_ns);
  double speed_m_s = 0;
  if (trail.display_ns > 0 && elapsed_s > 0 && elapsed_s < kGap_s) {
    double path_m = 0;
    for (std::size_t i = 0; i < landmarks_m.size(); ++i)
      path_m += glm::length(landmarks_m[i] - trail.landmarks_m[i]);
    speed_m_s = path_m / (elapsed_s * static_cast<double>(landmarks_m.size()));
    const auto step = static_cast<std::size_t>(speed_m_s / kStep_m_s);
    ++counts_[std::min(step, counts_.size() - 1)];
    ++count_;
    sum_m_s_ += speed_m_s;
  }
  trail = {display_ns, landmarks_m};
  return speed_m_s;
}

nlohmann::json HandSpeed::to_json() const {
  if (count_ == 0) return nullptr;
  std::size_t step = 0;
  for (std::int64_t slower = 0;
       step < counts_.size() && 100 * (slower += counts_[step]) < 95 * count_;)
    ++step;
  return {{"mean", sum_m_s_ / static_cast<double>(count_)},
          {"p95", kStep_m_s * (static_cast<double>(step) + 0.5)}};
}

}  // namespace handcast::simulate
