// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdlib>

#include "ipc/base/log.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/daemon/contract.hpp"
#include "supervisor/base/options.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/rig/applied_rig.hpp"
#include "supervisor/rig/rig_runner.hpp"
#include "supervisor/rig/takeover.hpp"
#include "supervisor/succession/keeper.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::string_view kNoKeeper = "--no-keeper";  ///< for systemd, which acts as the keeper
constexpr std::string_view kKept = "--kept";           ///< added by the keeper

bool take_successor_mark() {
  const bool is_successor = std::getenv(kSuccessorVariable) != nullptr;
  unsetenv(kSuccessorVariable);
  return is_successor;
}

/// Makes this process the keeper of the same command, whose files a successor finds even if the
/// folder that it was started in is deleted.
int keep_up(const Options& options) {
  Arguments command{(program_folder() / "handcast").string(), "up",
                    std::filesystem::absolute(options.words.front())};
  for (const auto& setting : options.all("--set"))
    command.insert(command.end(), {"--set", setting});
  if (options.has("--seconds"))
    command.insert(command.end(), {"--seconds", options.value("--seconds")});
  if (options.has("--out"))
    command.insert(command.end(), {"--out", std::filesystem::absolute(options.value("--out"))});
  command.emplace_back(kKept);
  return keep(command);
}

/// The options of the command. Also passes the folder of --out on to the services.
RunOptions run_options(const Options& options, std::optional<double> seconds) {
  RunOptions run{.rig_file = std::filesystem::absolute(options.words.front()),
                 .settings = options.all("--set"),
                 .program_folder = program_folder(),
                 .seconds = seconds,
                 .out = {},
                 .is_successor = take_successor_mark()};
  if (options.has("--out")) {
    run.out = std::filesystem::absolute(options.value("--out"));
    setenv(daemon::kOutVariable, run.out->c_str(), 1);
  }
  return run;
}

/// Creates the folder of --out before a service wants to write into it.
Result<void> create_out(const std::optional<std::filesystem::path>& out) {
  std::error_code error;
  if (!out || std::filesystem::is_directory(*out, error)) return {};
  std::filesystem::create_directories(*out, error);
  if (!error) return {};
  return fail(Errc::bad_config,
              fmt::format("--out: {} cannot be created: {}", out->string(), error.message()));
}

int run(RunOptions options) {
  if (const auto created = create_out(options.out); !created) return complain(created.error());
  const auto applied = applied_before(options.rig_file, options.settings);
  if (applied &&
      (!control::has_supervisor(applied->name) || end_supervisor_without_keeper(applied->name)))
    log::info("rig '{}' continues with its applied settings; `handcast reload` reads {}",
              applied->name, options.rig_file.string());
  const auto rig = applied ? *applied : load_rig_to_apply(options.rig_file, options.settings);
  if (!rig) return complain(rig.error());
  auto runner = RigRunner::open(*rig, std::move(options));
  if (!runner) return complain(runner.error());
  return (*runner)->run();
}

}  // namespace

int run_up(const Arguments& arguments) {
  const auto options = sort_options(arguments, {.with_value = {"--set", "--seconds", "--out"},
                                                .flags = {kNoKeeper, kKept},
                                                .words = {"RIG.toml"}});
  if (!options) return complain(kExitUsage, "up: " + options.error().what + "; `handcast help up`");
  log::never_wait_for_stderr();
  std::optional<double> seconds;
  if (options->has("--seconds")) {
    const auto parsed = parse_seconds(options->value("--seconds"));
    if (!parsed) return complain(kExitUsage, "up: " + parsed.error().what);
    seconds = *parsed;
  }
  if (!options->has(kKept) && !options->has(kNoKeeper)) return keep_up(*options);
  return run(run_options(*options, seconds));
}

}  // namespace handcast::supervisor
