// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/evaluation/chart/chart.hpp"

namespace handcast::chart {

/// What a page says about its making.
struct Imprint {
  std::string title, machine, date;
};

/// The whole page: one file that needs nothing beside it, no network and no script. `drawings` are
/// the charts' SVGs, in their order; "" for a chart that lacks its results.
std::string make_page(const Results& results, const std::vector<Chart>& charts,
                      const std::vector<std::string>& drawings, const Imprint& imprint);

}  // namespace handcast::chart
