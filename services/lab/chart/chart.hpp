// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/lab/chart/number_table.hpp"
#include "services/lab/chart/results.hpp"

namespace handcast::chart {

/// A chart and the numbers behind it.
struct Chart {
  std::string name;                 ///< name of its files, without extension
  std::string title;                ///< heading on the page
  std::string reading;              ///< explanation on the page
  std::string script;               ///< for gnuplot; "" if the results lack what the chart needs
  std::string lacking;              ///< what the chart needs: "needs runs ..."; "" with a script
  std::vector<NumberTable> tables;  ///< empty without a script
};

/// Makes one chart of the results.
/// @{
/// Speed against accuracy.
Chart chart_a(const Results& results);
/// Error against stress: a panel per stress, with the points at which the error doubles.
Chart chart_b(const Results& results);
/// The failure atlas.
Chart chart_b_faults(const Results& results);
/// Error against degrees of freedom, and against time.
Chart chart_c(const Results& results);
/// @}

}  // namespace handcast::chart
