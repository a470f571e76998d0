// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace handcast::chart {

/// A point of a chart, in the units of its axes or in pixels.
struct Point {
  double x = 0;  ///< to the right
  double y = 0;  ///< upwards on axes, downwards in pixels
};

/// The indices of the Pareto-optimal points, by ascending x: no other point is at most as large in
/// both coordinates and smaller in one.
std::vector<std::size_t> pareto_front(std::span<const Point> points);

/// The point at which y first reaches `times` its value at the first point, interpolated linearly;
/// empty if it never does. The points must be in the order of ascending x.
std::optional<Point> breakdown_point(std::span<const Point> points, double times = 2);

/// Moves marks on a line apart until neighbours have a distance of at least `gap`. The order is
/// kept, the sum of squared displacements is minimal, and all marks stay between `low` and `high`
/// if they fit.
std::vector<double> spread_apart(std::span<const double> marks, double gap, double low,
                                 double high);

}  // namespace handcast::chart
