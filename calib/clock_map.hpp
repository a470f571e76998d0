// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <vector>

namespace handcast::calib {

/// Maps the clock of a device to CLOCK_MONOTONIC, from the device's time stamps of items and the
/// times at which they arrived. No item can arrive earlier than its least delay after its stamp, so
/// all arrivals lie on or above a line; the map is a line that touches them from below (lower
/// envelope), over the last 8 s, so that it follows the drift of the clocks. The constant least
/// delay cannot be told from an offset of the clocks and stays in the map. One thread.
class ClockMap {
 public:
  /// A time of CLOCK_MONOTONIC and its uncertainty.
  struct HostTime {
    std::int64_t ns = 0;
    std::int64_t error_ns = 0;  ///< how far it may be off; the constant delay is not included
  };

  /// Adds an item by its two times. If the device's clock has gone back, or has been set, the map
  /// begins anew.
  void add(std::int64_t device_ns, std::int64_t arrival_ns);

  /// The earliest time at which an item with this stamp can have arrived: its time by the host's
  /// clock plus the least delay. Call add() first.
  HostTime earliest_arrival(std::int64_t device_ns) const;
  /// How much faster the host's clock runs than the device's, in parts per million. 0 in the first
  /// second.
  double drift_ppm() const { return slope_ * 1e6; }

 private:
  /// The item of a tenth of a second whose arrival was the earliest relative to its stamp.
  struct Point {
    std::int64_t bin = 0;  ///< number of the tenth
    double device_s = 0;   ///< its stamp, since the first one
    double delay_s = 0;    ///< arrival minus stamp, less that of the first item
  };

  double line_at(double device_s) const { return height_s_ + slope_ * (device_s - middle_s_); }
  void begin(std::int64_t device_ns, std::int64_t arrival_ns);
  /// Adds the point to its tenth; true if the line may have changed.
  bool keep(const Point& point);
  void fit();
  void touch_from_below();
  double median_distance_s() const;
  double fit_line(const std::vector<Point>& points);

  std::deque<Point> points_;  ///< of the last 8 s, in the order of time
  std::int64_t first_device_ns_ = 0, first_delay_ns_ = 0, last_device_ns_ = 0;
  /// The line: the delay is height_s_ at middle_s_ and grows by slope_.
  /// @{
  double middle_s_ = 0, height_s_ = 0, slope_ = 0;
  /// @}
  /// Twice the median distance of the points from the line, and more in the first second.
  double error_s_ = 0;
};

}  // namespace handcast::calib
