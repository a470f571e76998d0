// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/evaluation/chart/analysis.hpp"
#include "services/evaluation/chart/methods.hpp"
#include "services/evaluation/chart/results.hpp"

namespace handcast::chart {

/// One thing that is made worse and worse, and what suffers.
struct Stress {
  std::string_view setting;  ///< that the sweep turns
  std::string_view title, unit;
  double scale = 1;          ///< from the setting to the unit
  std::string_view measure;  ///< column of the x axis; "": the setting itself
  std::string_view harm;     ///< column of the y axis
  std::string_view harm_title;
  bool of_one = false;  ///< harm is what the column lacks to 1, in percent
};

std::span<const Stress> stresses();

struct StressLine {
  Method method;
  std::vector<Point> points;   ///< by ascending stress, in the stress's unit
  std::vector<double> levels;  ///< what the setting is at each of them
  std::optional<Point> breakdown;
};

/// The methods under a stress; empty where the results have none of it.
std::vector<StressLine> lines_of(const Results& results, const Stress& stress);

}  // namespace handcast::chart
