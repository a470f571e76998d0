// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/analysis.hpp"

#include <algorithm>
#include <numeric>

namespace handcast::chart {
namespace {

bool beats(const Point& a, const Point& b) {
  return a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
}

template <class Value, class Key>
std::vector<std::size_t> ascending(std::span<const Value> values, const Key& key) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return key(values[i]); });
  return order;
}

/// Marks that touch. They are moved as one to the mean of their wanted places.
struct Cluster {
  double sum = 0;  ///< sum over the marks of the place of the first that would suit the mark
  std::size_t count = 0;

  double first(double gap, double low, double high) const {
    const double highest = high - gap * static_cast<double>(count - 1);
    return std::max(low, std::min(sum / static_cast<double>(count), highest));
  }
};

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const Point> points) {
  auto front = ascending(points, [](const Point& point) { return point.x; });
  std::erase_if(front, [&](std::size_t i) {
    return std::ranges::any_of(points, [&](const Point& other) { return beats(other, points[i]); });
  });
  return front;
}

std::optional<Point> breakdown_point(std::span<const Point> points, double times) {
  if (points.empty() || points.front().y <= 0) return std::nullopt;
  const double limit = times * points.front().y;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto &a = points[i - 1], &b = points[i];
    if (b.y >= limit) return Point{a.x + (b.x - a.x) * (limit - a.y) / (b.y - a.y), limit};
  }
  return std::nullopt;
}

std::vector<double> spread_apart(std::span<const double> marks, double gap, double low,
                                 double high) {
  const auto order = ascending(marks, [](double mark) { return mark; });
  std::vector<Cluster> clusters;
  for (const auto i : order) {
    clusters.push_back({marks[i], 1});
    while (clusters.size() > 1) {
      const auto last = clusters.back();
      auto& before = clusters[clusters.size() - 2];
      const double before_ends =
          before.first(gap, low, high) + gap * static_cast<double>(before.count);
      if (last.first(gap, low, high) >= before_ends) break;
      before.sum += last.sum - gap * static_cast<double>(before.count * last.count);
      before.count += last.count;
      clusters.pop_back();
    }
  }
  std::vector<double> places(marks.size());
  std::size_t next = 0;
  for (const auto& cluster : clusters)
    for (std::size_t k = 0; k < cluster.count; ++k)
      places[order[next++]] = cluster.first(gap, low, high) + gap * static_cast<double>(k);
  return places;
}

}  // namespace handcast::chart
