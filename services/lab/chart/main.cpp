// SPDX-License-Identifier: Apache-2.0
// handcast chart: draws the results of sweeps as charts on one page.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "services/lab/chart/write.hpp"
#include "services/tools/page/machine.hpp"

using namespace handcast;

static const char* const kFooter =
    R"(A: speed against accuracy. B: where methods fail, and the failure atlas. C: error against degrees of freedom and time.
The charts need the results of these plans in config/sweeps: A and C ladder.toml, and times.toml for frame times; B stress.toml and
failures.toml. scripts/charts runs all of them.)";

static int run_verb(int argc, char** argv) {
  CommandLine line(
      "handcast chart",
      "Draws the results of sweeps: a self-contained page, the charts as SVG, and the numbers "
      "behind them as CSV.",
      kFooter);
  chart::Order order;
  order.imprint = {"handcast: speed against accuracy", page::this_machine(),
                   fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))};
  order.folder = "out/charts";
  line.add("RESULTS.csv...", order.results, "Files of `handcast sweep`");
  line.add("--out DIR", order.folder, "Folder for charts.html, *.svg and *.csv");
  line.add("--title TEXT", order.imprint.title, "Heading of the page");
  line.add("--gnuplot FILE", order.gnuplot, "The gnuplot program");
  if (const auto code = line.answered(argc, argv)) return *code;

  const auto written = chart::write_charts(order);
  if (!written) {
    fmt::print(stderr, "handcast chart: {}\n", written.error().what);
    return exit_code_of(written.error());
  }
  for (const auto& sentence : written->lacking)
    fmt::print(stderr, "handcast chart: {}\n", sentence);
  fmt::print("{}\n", written->page.string());
  return kExitDone;
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast chart", argc, argv, run_verb);
}
