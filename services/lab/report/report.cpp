// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/report.hpp"

#include "ipc/base/write_whole.hpp"

namespace handcast::report {
namespace fs = std::filesystem;

/// The metrics of all runs in one object: baseline, paper, handcast, handcast_equal_legs, and live
/// with the observer's score. Missing ones are left out.
static nlohmann::json gather_metrics(const Inputs& inputs) {
  auto metrics = nlohmann::json::object();
  for (const auto& run : inputs.runs)
    if (run.metrics.content) metrics[run.name] = *run.metrics.content;
  if (inputs.equal_legs.content) metrics["handcast_equal_legs"] = *inputs.equal_legs.content;
  if (inputs.live.content) metrics["live"] = *inputs.live.content;
  if (inputs.observer.content) metrics["live"]["observer"] = *inputs.observer.content;
  return metrics;
}

Result<Written> write_report(const fs::path& folder, const Imprint& imprint) {
  const auto inputs = read_inputs(folder);
  if (!inputs) return tl::make_unexpected(inputs.error());
  const Film film = make_film(*inputs, folder / "preview.mp4");
  if (auto written = write_whole(folder / "metrics.json", gather_metrics(*inputs).dump(2) + "\n");
      !written)
    return tl::make_unexpected(written.error());
  const fs::path page = folder / "report.html";
  if (auto written = write_whole(page, make_page(*inputs, film, imprint)); !written)
    return tl::make_unexpected(written.error());
  return Written{page, faults_of(*inputs)};
}

}  // namespace handcast::report
