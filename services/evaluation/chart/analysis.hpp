// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace handcast::chart {

struct Point {
  double x = 0, y = 0;
};

/// Which points no other beats: none is as small in both and smaller in one. By ascending x.
std::vector<std::size_t> pareto_front(std::span<const Point> points);

/// Where y first reaches `times` its value at the mildest stress, the first point; between two
/// points on the line between them. None where it never does. Points by ascending stress.
std::optional<Point> breakdown_point(std::span<const Point> points, double times = 2);

/// Moves marks on a line apart so that neighbours have at least `gap` between them, keeps their
/// order and all between `low` and `high` where there is room, and moves them as little as that
/// allows.
std::vector<double> spread_apart(std::span<const double> marks, double gap, double low,
                                 double high);

}  // namespace handcast::chart
