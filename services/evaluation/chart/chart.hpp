// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/evaluation/chart/number_table.hpp"
#include "services/evaluation/chart/results.hpp"

namespace handcast::chart {

/// One picture, the numbers behind it, and what to see in it.
struct Chart {
  std::string name;  ///< of its files, without ending
  std::string title;
  std::string reading;
  std::string script;   ///< for gnuplot; empty where the results lack what it shows
  std::string lacking;  ///< the sentence that says so
  std::vector<NumberTable> tables;
};

Chart chart_a(const Results& results);  ///< speed against accuracy
Chart chart_b(
    const Results& results);  ///< one panel per stress, with the point where the error doubles
Chart chart_b_faults(const Results& results);  ///< the failure atlas
Chart chart_c(const Results& results);  ///< error against degrees of freedom, and against time

}  // namespace handcast::chart
