// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/clock_map.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::bridge {
namespace {

/// The kernel slews a clock by at most 500 ppm, and a crystal is off by at most 100.
constexpr double kMostDrift = 600e-6;
/// How much a clock's rate changes within a window. Veitch, Ridoux and Korada ("Robust
/// Synchronization of Absolute and Difference Clocks Over Networks", 2009) find 0.1 ppm for that of
/// a PC at rest; the clock of one that chrony steers changes by some ppm in a minute.
constexpr double kWander = 1e-6;
constexpr std::int64_t kWindow_ns = 20'000'000'000;

/// The width of the interval in which the offset lies by one exchange alone: the time on the way.
std::int64_t width_of(const ClockExchange& exchange) {
  return exchange.heard_ns - exchange.asked_ns - (exchange.answered_ns - exchange.arrived_ns);
}

}  // namespace

/// Keeps the part of the polygon in which sign * (offset + drift * since) <= sign * limit.
template <class Line>
static void clip(std::vector<Line>& corners, double sign, double since, double limit) {
  const auto beyond = [&](const Line& line) {
    return sign * (line.offset + line.drift * since - limit);
  };
  std::vector<Line> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &from = corners[i], &to = corners[(i + 1) % corners.size()];
    const double a = beyond(from), b = beyond(to);
    if (a <= 0) kept.push_back(from);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
      const double part = a / (a - b);
      kept.push_back({from.offset + part * (to.offset - from.offset),
                      from.drift + part * (to.drift - from.drift)});
    }
  }
  corners = std::move(kept);
}

/// Whether the lines of the polygon fit to an exchange; if so, only those that do remain.
bool ClockMap::bound(const ClockExchange& exchange) {
  auto corners = corners_;
  const auto clip_by = [&](double sign, std::int64_t offset_ns, std::int64_t our_ns) {
    const auto since = static_cast<double>(our_ns - newest_ns_);
    const double slack = kWander * std::abs(since);
    clip(corners, sign, since, static_cast<double>(offset_ns - reference_ns_) + sign * slack);
  };
  clip_by(1, exchange.arrived_ns - exchange.asked_ns, exchange.asked_ns);
  clip_by(-1, exchange.answered_ns - exchange.heard_ns, exchange.heard_ns);
  if (corners.empty()) return false;
  corners_ = std::move(corners);
  return true;
}

ClockMap::News ClockMap::add(const ClockExchange& exchange) {
  for (const auto their_ns : {exchange.arrived_ns, exchange.answered_ns})
    if (their_ns < 0 || their_ns > kLatest_ns) return News::impossible;
  const auto there_ns = exchange.answered_ns - exchange.arrived_ns;
  const auto here_ns = exchange.heard_ns - exchange.asked_ns;
  if (there_ns < 0 || here_ns < there_ns) return News::impossible;
  if (!exchanges_.empty() && exchange.heard_ns < newest_ns_) return News::impossible;
  const auto before = at(exchange.heard_ns);
  exchanges_.push_back(exchange);
  newest_ns_ = exchange.heard_ns;
  while (exchanges_.front().heard_ns < newest_ns_ - kWindow_ns) exchanges_.pop_front();
  reference_ns_ = exchange.answered_ns - exchange.heard_ns;
  // Within the box is every line that fits to this exchange.
  const auto width =
      static_cast<double>(here_ns - there_ns) + 1 + kMostDrift * static_cast<double>(here_ns);
  corners_ = {{-width, -kMostDrift},
              {2 * width, -kMostDrift},
              {2 * width, kMostDrift},
              {-width, kMostDrift}};
  // The newest first: what no longer fits is older than a change of a clock.
  auto oldest = exchanges_.end();
  while (oldest != exchanges_.begin() && bound(*std::prev(oldest))) --oldest;
  exchanges_.erase(exchanges_.begin(), oldest);
  least_error_ns_ = width_of(exchange);
  for (const auto& kept : exchanges_) least_error_ns_ = std::min(least_error_ns_, width_of(kept));
  least_error_ns_ /= 2;
  const auto now = at(exchange.heard_ns);
  const bool fits =
      !before || std::abs(before->offset_ns - now->offset_ns) <= before->error_ns + now->error_ns;
  return fits ? News::none : News::jumped;
}

std::optional<ClockReading> ClockMap::at(std::int64_t our_ns) const {
  if (corners_.empty()) return std::nullopt;
  const auto since = static_cast<double>(our_ns - newest_ns_);
  const auto offset = [&](const Line& line) { return line.offset + line.drift * since; };
  const auto [least, most] = std::ranges::minmax_element(corners_, {}, offset);
  const auto [slowest, fastest] = std::ranges::minmax_element(corners_, {}, &Line::drift);
  const double low = offset(*least), high = offset(*most);
  return ClockReading{reference_ns_ + std::llround((low + high) / 2),
                      std::max<std::int64_t>(std::llround((high - low) / 2), least_error_ns_) +
                          std::llround(kWander * std::abs(since)),
                      (slowest->drift + fastest->drift) / 2 * 1e6};
}

std::optional<std::int64_t> ClockMap::to_ours(std::int64_t their_ns) const {
  if (corners_.empty() || their_ns < 0 || their_ns > kLatest_ns) return std::nullopt;
  auto our_ns = their_ns - reference_ns_;
  for (int i = 0; i < 2; ++i) our_ns = their_ns - at(our_ns)->offset_ns;  // a drift is small
  return our_ns;
}

}  // namespace handcast::bridge
