// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/evaluation/chart/page.hpp"

namespace handcast::chart {

struct Order {
  std::vector<std::filesystem::path> results;  ///< files of `handcast sweep`
  std::filesystem::path folder;                ///< is made if it is not there
  Imprint imprint;
  std::string gnuplot = "gnuplot";
};

struct Written {
  std::filesystem::path page;
  std::vector<std::string> lacking;  ///< a sentence for every chart that could not be drawn
};

/// Writes charts.html, and for every chart that can be drawn its SVG and the numbers behind it as
/// CSV. Errors: those of read_results and run_gnuplot; bad_data (no chart can be drawn); bad_config
/// (the folder cannot be written).
Result<Written> write_charts(const Order& order);

}  // namespace handcast::chart
