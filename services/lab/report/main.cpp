// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/program.hpp"
#include "services/lab/report/report.hpp"
#include "services/tools/page/machine.hpp"

using namespace handcast;

static int run_verb(int argc, char** argv) {
  CommandLine line(
      "handcast report",
      "Makes report.html, metrics.json and preview.mp4 from the results of a demonstration.");
  std::string folder;
  report::Imprint imprint{"handcast: light that stays on moving hands", page::this_machine(),
                          fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))};
  line.add("--out DIR", folder,
           "Folder with baseline.json, paper.json, twin.json, live.json, observer.json and "
           "frames/; the report is written to it");
  line.add("--title TEXT", imprint.title, "Heading of the page");
  if (const auto code = line.answered(argc, argv)) return *code;
  if (folder.empty()) return line.refuse("--out is missing");

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
