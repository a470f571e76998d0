// SPDX-License-Identifier: Apache-2.0
// handcast day: prints what the night watch has written of a day.
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "config/live/live_board.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "services/watch/day.hpp"
#include "services/watch/report.hpp"

namespace handcast::day {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string date, rig;
  fs::path folder;
  bool list = false, as_json = false;
};

/// The folder of the reports of a rig that is up.
Result<fs::path> folder_of(const std::string& rig) {
  const auto board = config::LiveBoard::open(rig);
  if (!board)
    return fail(board.error().code,
                board.error().what + "; `handcast day --folder DIR` needs no rig");
  const auto& settings = board->filed().watch;
  if (!settings.enabled)
    return fail(Errc::bad_config,
                fmt::format("rig '{}' has no night watch; write enabled = true into [watch] of {}",
                            board->filed().name, board->file().string()));
  return watch::folder_of(settings, board->file());
}

Result<void> print(const Options& options) {
  const auto folder = options.folder.empty() ? folder_of(options.rig) : options.folder;
  if (!folder) return tl::make_unexpected(folder.error());
  const auto dates = watch::dates_in(*folder);
  if (options.list || dates.empty()) {
    for (const auto& date : dates) fmt::print("{}\n", date);
    if (!options.list)
      return fail(Errc::unavailable, fmt::format("{} has no report", folder->string()));
    return {};
  }
  const auto date = options.date.empty() ? dates.back() : options.date;
  const auto day = watch::load_day(*folder, date);
  if (!day) return tl::make_unexpected(day.error());
  if (!*day)
    return fail(Errc::bad_config, fmt::format("there is no report of {}; the newest is of {}",
                                              quote(date), dates.back()));
  if (options.as_json)
    fmt::print("{}", watch::to_json(**day));
  else
    fmt::print("{}page       {}\n", watch::report_text(**day),
               printable(watch::page_file(*folder, date).string()));
  return {};
}

int run(int argc, char** argv) {
  Options options;
  CommandLine line("handcast day", "Prints the report of a day of the rig, and names its page.",
                   "The night watch writes it: see [watch] of the rig file.");
  line.add("[DATE]", options.date, "The day, as 2026-12-24; the newest if left out");
  line.add("--json", options.as_json, "As JSON");
  line.add("--list", options.list, "Lists the days that there are");
  line.add("--rig NAME", options.rig, "Which rig, if several are up");
  line.add("--folder DIR", options.folder, "The folder of the reports, of a rig that is not up");
  if (const auto code = line.answered(argc, argv)) return *code;
  const auto printed = print(options);
  if (printed) return kExitDone;
  fmt::print(stderr, "handcast day: {}\n", printable(printed.error().what));
  return exit_code_of(printed.error());
}

}  // namespace
}  // namespace handcast::day

int main(int argc, char** argv) {
  return handcast::run_program("handcast day", argc, argv, handcast::day::run);
}
