// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/write.hpp"

#include <fmt/format.h>

#include "ipc/base/write_whole.hpp"
#include "services/lab/chart/gnuplot.hpp"
#include "services/lab/chart/svg.hpp"

namespace handcast::chart {
namespace {

Result<std::vector<std::string>> draw(const std::vector<Chart>& charts,
                                      const std::string& gnuplot) {
  std::vector<std::string> drawings;
  for (const auto& chart : charts) {
    if (chart.script.empty()) {
      drawings.emplace_back();
      continue;
    }
    const auto svg = run_gnuplot(chart.script, gnuplot);
    if (!svg) return fail_in(chart.name, svg.error());
    drawings.push_back(as_file(*svg, chart.title));
  }
  return drawings;
}

Result<void> write_chart(const std::filesystem::path& folder, const Chart& chart,
                         const std::string& drawing) {
  if (auto written = write_whole(folder / (chart.name + ".svg"), drawing); !written) return written;
  for (const auto& table : chart.tables)
    if (auto written = write_whole(folder / (table.name + ".csv"), to_csv(table)); !written)
      return written;
  return {};
}

}  // namespace

Result<Written> write_charts(const Order& order) {
  const auto results = read_results(order.results);
  if (!results) return tl::make_unexpected(results.error());
  const std::vector<Chart> charts{chart_a(*results), chart_b(*results), chart_b_faults(*results),
                                  chart_c(*results)};
  Written written{order.folder / "charts.html", {}};
  for (const auto& chart : charts)
    if (chart.script.empty())
      written.lacking.push_back(fmt::format("{} {}", chart.name, chart.lacking));
  if (written.lacking.size() == charts.size())
    return fail(Errc::bad_data, fmt::format("no chart can be drawn from these results: {}",
                                            fmt::join(written.lacking, "; ")));

  const auto drawings = draw(charts, order.gnuplot);
  if (!drawings) return tl::make_unexpected(drawings.error());
  std::error_code failed;
  std::filesystem::create_directories(order.folder, failed);
  for (std::size_t i = 0; i < charts.size(); ++i)
    if (!charts[i].script.empty())
      if (auto done = write_chart(order.folder, charts[i], (*drawings)[i]); !done)
        return tl::make_unexpected(done.error());
  if (auto done = write_whole(written.page, make_page(*results, charts, *drawings, order.imprint));
      !done)
    return tl::make_unexpected(done.error());
  return written;
}

}  // namespace handcast::chart
