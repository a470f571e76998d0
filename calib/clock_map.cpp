// SPDX-License-Identifier: Apache-2.0
#include "calib/clock_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ipc/base/clock.hpp"

namespace handcast::calib {
namespace {

constexpr std::int64_t kBin_ns = 100'000'000;
constexpr std::int64_t kBins = 80;
/// Two quartz clocks differ by less than this.
constexpr double kLargestDrift = 500e-6;
/// The slope of a shorter time is not known better than 0.
constexpr double kShortest_s = 1;
/// Drift that must be expected while the slope is unknown.
constexpr double kUsualDrift = 50e-6;
/// An item that comes so much too early shows that a clock was set.
constexpr double kClockWasSet_s = 0.005;

}  // namespace

void ClockMap::add(std::int64_t device_ns, std::int64_t arrival_ns) {
  if (points_.empty() || device_ns < last_device_ns_) begin(device_ns, arrival_ns);
  const double device_s = ns_to_seconds(device_ns - first_device_ns_);
  const double delay_s = ns_to_seconds(arrival_ns - device_ns - first_delay_ns_);
  last_device_ns_ = device_ns;
  if (!points_.empty() && delay_s < line_at(device_s) - kClockWasSet_s) {
    begin(device_ns, arrival_ns);
    return add(device_ns, arrival_ns);
  }
  if (keep({(device_ns - first_device_ns_) / kBin_ns, device_s, delay_s})) fit();
}

ClockMap::HostTime ClockMap::earliest_arrival(std::int64_t device_ns) const {
  const double device_s = ns_to_seconds(device_ns - first_device_ns_);
  return {device_ns + first_delay_ns_ + seconds_to_ns(line_at(device_s)), seconds_to_ns(spread_s_)};
}

void ClockMap::begin(std::int64_t device_ns, std::int64_t arrival_ns) {
  points_.clear();
  first_device_ns_ = device_ns;
  first_delay_ns_ = arrival_ns - device_ns;
  middle_s_ = height_s_ = slope_ = spread_s_ = 0;
}

bool ClockMap::keep(const Point& point) {
  if (points_.empty() || point.bin != points_.back().bin) {
    points_.push_back(point);
    while (points_.front().bin <= point.bin - kBins) points_.pop_front();
    return true;
  }
  if (point.delay_s >= points_.back().delay_s) return false;
  points_.back() = point;
  return true;
}

/// The tenth that is still going on takes part only if it lowers the line.
void ClockMap::fit() {
  const double span_s = points_.back().device_s - points_.front().device_s;
  if (span_s < kShortest_s) {
    slope_ = 0;
    middle_s_ = points_.back().device_s;
    height_s_ = std::ranges::min(points_, {}, &Point::delay_s).delay_s;
  } else {
    touch_from_below();
  }
  std::vector<double> above_s;
  for (const auto& point : points_) above_s.push_back(point.delay_s - line_at(point.device_s));
  const auto middle = above_s.begin() + static_cast<std::ptrdiff_t>((above_s.size() - 1) / 2);
  std::nth_element(above_s.begin(), middle, above_s.end());
  spread_s_ = 2 * std::max(*middle, 0.) + (span_s < kShortest_s ? kUsualDrift * kShortest_s : 0);
}

/// Of all lines below the points, the one with the least sum of distances is the edge of their
/// lower convex hull above the mean of their times.
void ClockMap::touch_from_below() {
  std::vector<Point> hull;
  const auto is_above = [](const Point& a, const Point& b, const Point& c) {
    return (b.delay_s - a.delay_s) * (c.device_s - a.device_s) >=
           (c.delay_s - a.delay_s) * (b.device_s - a.device_s);
  };
  double mean_s = 0;
  for (const auto& point : points_) {
    while (hull.size() >= 2 && is_above(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
    hull.push_back(point);
    mean_s += point.device_s / static_cast<double>(points_.size());
  }
  auto right =
      std::ranges::find_if(hull, [mean_s](const Point& point) { return point.device_s > mean_s; });
  if (right == hull.begin()) ++right;
  const Point &a = *(right - 1), &b = *right;
  slope_ = std::clamp((b.delay_s - a.delay_s) / (b.device_s - a.device_s), -kLargestDrift,
                      kLargestDrift);
  middle_s_ = a.device_s;
  height_s_ = a.delay_s;
}

}  // namespace handcast::calib
