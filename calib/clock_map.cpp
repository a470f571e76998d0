// SPDX-License-Identifier: Apache-2.0
#include "calib/clock_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr std::int64_t kBin_ns = 100'000'000;
constexpr std::int64_t kBins = 80;
/// Two quartz clocks differ by less than this.
constexpr double kLargestDrift = 500e-6;
/// Over a shorter time, the slope is taken to be 0.
constexpr double kShortest_s = 1;
/// Standard deviation of the drift between two clocks.
constexpr double kUsualDrift = 50e-6;
/// Neighbouring points wait alike on a busy machine: this many count as one independent point.
constexpr double kBusyPoints = 10;
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
  return {device_ns + first_delay_ns_ + seconds_to_ns(line_at(device_s)), seconds_to_ns(error_s_)};
}

void ClockMap::begin(std::int64_t device_ns, std::int64_t arrival_ns) {
  points_.clear();
  first_device_ns_ = device_ns;
  first_delay_ns_ = arrival_ns - device_ns;
  middle_s_ = height_s_ = slope_ = error_s_ = 0;
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

void ClockMap::fit() {
  const double span_s = points_.back().device_s - points_.front().device_s;
  if (span_s < kShortest_s) {
    slope_ = 0;
    middle_s_ = points_.back().device_s;
    height_s_ = std::ranges::min(points_, {}, &Point::delay_s).delay_s;
  } else {
    touch_from_below();
  }
  error_s_ = 2 * median_distance_s() + (span_s < kShortest_s ? kUsualDrift * kShortest_s : 0);
}

double ClockMap::median_distance_s() const {
  std::vector<double> distances_s;
  for (const auto& point : points_)
    distances_s.push_back(std::abs(point.delay_s - line_at(point.device_s)));
  return ranked(std::move(distances_s), (points_.size() - 1) / 2);
}

/// The slope is that of the half of the points that lie lowest (least trimmed squares, in a few
/// rounds): the edge of the lower hull would follow two fast items that are close together. Its
/// prior is a slope of 0 with standard deviation kUsualDrift, which weighs more if the points
/// scatter, because most of them waited on a busy machine. The line then goes down until it touches
/// the lowest point.
void ClockMap::touch_from_below() {
  std::vector<Point> lowest(points_.begin(), points_.end());
  for (int round = 0; round < 3; ++round) {
    fit_line(lowest);
    const auto above = [this](const Point& point) {
      return point.delay_s - line_at(point.device_s);
    };
    lowest.assign(points_.begin(), points_.end());
    std::ranges::nth_element(
        lowest, lowest.begin() + static_cast<std::ptrdiff_t>(lowest.size() / 2), {}, above);
    lowest.resize(lowest.size() / 2 + 1);
  }
  const double scatter = median_distance_s() / kUsualDrift;
  const double square = fit_line(lowest);
  if (square > 0) slope_ *= square / (square + kBusyPoints * scatter * scatter);
  double under_s = 0;
  for (const auto& point : points_)
    under_s = std::min(under_s, point.delay_s - line_at(point.device_s));
  height_s_ += under_s;
}

/// Least squares. Returns the sum of the squares of the points' times about their mean.
double ClockMap::fit_line(const std::vector<Point>& points) {
  const auto count = static_cast<double>(points.size());
  middle_s_ = height_s_ = 0;
  for (const auto& point : points) {
    middle_s_ += point.device_s / count;
    height_s_ += point.delay_s / count;
  }
  double product = 0, square = 0;
  for (const auto& point : points) {
    product += (point.device_s - middle_s_) * (point.delay_s - height_s_);
    square += (point.device_s - middle_s_) * (point.device_s - middle_s_);
  }
  slope_ = square > 0 ? std::clamp(product / square, -kLargestDrift, kLargestDrift) : 0;
  return square;
}

}  // namespace handcast::calib
