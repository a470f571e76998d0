// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/lab/chart/chart.hpp"

namespace handcast::chart {

/// Title and origin of a page.
struct Imprint {
  std::string title;    ///< plain text
  std::string machine;  ///< "AMD EPYC, 2 cores, Debian 12"
  std::string date;     ///< "2025-11-21 12:00 UTC"
};

/// The whole page: a self-contained HTML file without scripts that needs no network. `drawings` are
/// the SVGs of the charts in the same order; "" for a chart without a script.
std::string make_page(const Results& results, const std::vector<Chart>& charts,
                      const std::vector<std::string>& drawings, const Imprint& imprint);

}  // namespace handcast::chart
