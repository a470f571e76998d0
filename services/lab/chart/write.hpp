// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/lab/chart/page.hpp"

namespace handcast::chart {

/// The input and output of write_charts().
struct Order {
  std::vector<std::filesystem::path> results;  ///< files of `handcast sweep`
  std::filesystem::path folder;                ///< output; is created if it does not exist
  Imprint imprint;                             ///< title and origin of the page
  std::string gnuplot = "gnuplot";             ///< program; searched in PATH
};

/// The result of write_charts().
struct Written {
  std::filesystem::path page;        ///< charts.html
  std::vector<std::string> lacking;  ///< one per chart that was not drawn: "chart_a needs ..."
};

/// Writes charts.html, and the SVG and the CSV files of each chart that can be drawn. Errors: those
/// of read_results and run_gnuplot, bad_data (no chart can be drawn), those of write_whole().
Result<Written> write_charts(const Order& order);

}  // namespace handcast::chart
