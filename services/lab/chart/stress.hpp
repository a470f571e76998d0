// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "services/lab/chart/analysis.hpp"
#include "services/lab/chart/methods.hpp"
#include "services/lab/chart/results.hpp"

namespace handcast::chart {

/// A setting that is made worse step by step, and the metric that suffers from it: a panel of chart
/// B.
struct Stress {
  std::string_view setting;     ///< path of the axis of the sweep
  std::string_view title;       ///< of the panel
  std::string_view unit;        ///< of the x axis
  double scale = 1;             ///< factor from the setting to the unit
  std::string_view measure;     ///< column of the x axis; "" for the setting itself
  std::string_view harm;        ///< column of the y axis
  std::string_view harm_title;  ///< of the y axis, with the unit
  bool of_one = false;          ///< the y axis shows 1 - harm, in percent
};

/// All stresses, in the order of the panels.
std::span<const Stress> stresses();

/// One method under a stress.
struct StressLine {
  Method method;                   ///< the variant
  std::vector<Point> points;       ///< by ascending stress, in the units of the axes
  std::vector<double> levels;      ///< value of the setting by point
  std::optional<Point> breakdown;  ///< breakdown_point() of the points
};

/// The methods under a stress; empty if the results have no runs of it.
std::vector<StressLine> lines_of(const Results& results, const Stress& stress);

}  // namespace handcast::chart
