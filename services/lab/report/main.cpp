// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/verb_options.hpp"
#include "services/lab/report/report.hpp"
#include "services/tools/page/machine.hpp"

using namespace handcast;

static int run_verb(int argc, char** argv) {
  CLI::App app(
      "Makes report.html, metrics.json and preview.mp4 from the results of a demonstration.",
      "handcast report");
  std::string folder;
  report::Imprint imprint{"handcast: light that stays on moving hands", page::this_machine(),
                          fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))};
  app.add_option("--out", folder,
                 "Folder with baseline.json, paper.json, twin.json, live.json, observer.json and "
                 "frames/; the report is written to it")
      ->required();
  app.add_option("--title", imprint.title, "Heading of the page");
  if (const auto code = answered(app, parse_options(app, argc, argv))) return *code;

  const auto written = report::write_report(folder, imprint);
  if (!written) {
    fmt::print(stderr, "handcast report: {}\n", written.error().what);
    return exit_code_of(written.error());
  }
  fmt::print("{}\n", written->page.string());
  for (const auto& fault : written->faults) fmt::print(stderr, "handcast report: {}\n", fault);
  return written->faults.empty() ? kExitDone : kExitBadResult;
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast report", argc, argv, run_verb);
}
