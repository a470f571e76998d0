// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/jitter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handcast::simulate {
namespace {

constexpr double kLowest_hz = 1, kHighest_hz = 30;
constexpr int kFewestPoints = 20;  ///< of a part: fewer say more about their choice than the light
constexpr double kSettling_s = 0.3;  ///< in which a filter that starts in motion settles

}  // namespace

glm::dvec2 BandPass::Section::operator()(glm::dvec2 sample) {
  const glm::dvec2 out = b[0] * sample + b[1] * x[0] + b[2] * x[1] - a[0] * y[0] - a[1] * y[1];
  x = {sample, x[0]};
  y = {out, y[0]};
  return out;
}

BandPass::BandPass(double rate_hz) {
  const auto section = [&](double corner_hz, bool high) {
    const double k = std::tan(std::numbers::pi * corner_hz / rate_hz);
    const double norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
    const double gain = (high ? 1 : k * k) * norm;
    Section filter;
    filter.b = {gain, (high ? -2 : 2) * gain, gain};
    filter.a = {2 * (k * k - 1) * norm, (1 - std::numbers::sqrt2 * k + k * k) * norm};
    return filter;
  };
  high_ = section(kLowest_hz, true);
  low_ = section(kHighest_hz, false);
}

glm::dvec2 BandPass::operator()(glm::dvec2 sample) {
  if (!started_) high_.x = {sample, sample};
  started_ = true;
  return low_(high_(sample));
}

void JitterMeter::add(msg::Side side, std::int64_t time_ns, const Points& points,
                      double speed_m_s) {
  Hand& hand = hands_[static_cast<std::size_t>(side)];
  const std::int64_t step_ns = time_ns - hand.last_ns;
  const bool is_first = hand.last_ns == 0;
  hand.last_ns = time_ns;
  if (is_first) return;
  // Samples are evenly spaced except for gaps, in which the hand was not there.
  const bool is_shorter = hand.period_ns == 0 || 3 * step_ns < 2 * hand.period_ns;
  if (is_shorter || 2 * step_ns > 3 * hand.period_ns) hand.filters.clear();
  if (is_shorter) hand.period_ns = step_ns;
  hand.filters.resize(points.size());
  hand.lengths.resize(points.size());
  const double rate_hz = 1e9 / static_cast<double>(std::max<std::int64_t>(hand.period_ns, 1));
  if (rate_hz <= 2 * kHighest_hz) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto& filter = hand.filters[i];
    if (!points[i]) {
      filter.reset();
      continue;
    }
    if (!filter) {
      filter.emplace(rate_hz);
      hand.lengths[i] = 0;
    }
    const glm::dvec2 out = (*filter)(*points[i]);
    if (++hand.lengths[i] <= kSettling_s * rate_hz || speed_m_s > kSlow_m_s) continue;
    square_px2_ += glm::dot(out, out);
    ++samples_;
  }
}

std::optional<double> JitterMeter::rms_px() const {
  if (samples_ == 0) return std::nullopt;
  return std::sqrt(square_px2_ / static_cast<double>(samples_));
}

JitterMeter::Points light_points(const twin::FrameScore::Hand& hand) {
  JitterMeter::Points points;
  for (const auto& part : hand.parts)
    points.push_back(part.points < kFewestPoints
                         ? std::nullopt
                         : std::optional(glm::dvec2(part.sum_px) / double(part.points)));
  return points;
}

JitterMeter::Points landmark_points(const renderer::FrameHand& hand,
                                    const std::array<glm::vec2, msg::kLandmarks>& truth) {
  JitterMeter::Points points;
  for (std::size_t i = 0; i < truth.size(); ++i)
    points.emplace_back(glm::dvec2(hand.corrected[i] - truth[i]));
  return points;
}

}  // namespace handcast::simulate
