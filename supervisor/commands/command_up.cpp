// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/daemon/contract.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/rig/applied_rig.hpp"
#include "supervisor/rig/rig_runner.hpp"
#include "supervisor/rig/takeover.hpp"
#include "supervisor/spec/catalogue.hpp"
#include "supervisor/spec/fingerprint.hpp"
#include "supervisor/succession/keeper.hpp"

namespace handcast::supervisor {
namespace {

/// The command line.
struct Order {
  std::filesystem::path rig_file, out;  ///< absolute; `out` may be empty
  std::vector<std::string> settings;
  double seconds = 0;      ///< 0: until it is stopped
  bool no_keeper = false;  ///< for systemd, which acts as the keeper
  bool kept = false;       ///< --kept, which the keeper adds
};

bool take_successor_mark() {
  const bool is_successor = std::getenv(kSuccessorVariable) != nullptr;
  unsetenv(kSuccessorVariable);
  return is_successor;
}

/// Makes this process the keeper of the same command, whose files a successor finds even if the
/// folder that it was started in is deleted.
int keep_up(const Order& order) {
  Arguments command{(program_folder() / "handcast").string(), "up", order.rig_file};
  for (const auto& setting : order.settings) command.insert(command.end(), {"--set", setting});
  if (order.seconds > 0) command.push_back(fmt::format("--seconds={}", order.seconds));
  if (!order.out.empty()) command.push_back("--out=" + order.out.string());
  command.emplace_back("--kept");
  return keep(command);
}

/// The options of the command. Also passes the folder of --out on to the services.
RunOptions run_options(const Order& order) {
  RunOptions run{.rig_file = order.rig_file,
                 .settings = order.settings,
                 .program_folder = program_folder(),
                 .seconds = std::nullopt,
                 .out = {},
                 .is_successor = take_successor_mark()};
  if (order.seconds > 0) run.seconds = order.seconds;
  if (!order.out.empty()) {
    run.out = order.out;
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

void say_what_is_idle(const config::Rig& rig, const RunOptions& options) {
  const auto catalogue = read_catalogue(catalogue_folder(options.program_folder));
  for (const auto& note : idle_settings(rig, catalogue, options.settings))
    log::info("note: {}", note);
}

/// What may hinder a rig, so that a later error does not surprise.
void warn_of_surroundings() {
  for (const auto& obstacle : inherited::obstacles()) log::warning("{}", obstacle);
  for (const auto& rig : control::rigs_of_others())
    log::warning("{}; a device that both use is open to one of them only", rig);
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
  if (!applied) say_what_is_idle(*rig, options);
  auto runner = RigRunner::open(*rig, std::move(options));
  if (!runner) return complain(runner.error());
  return (*runner)->run();
}

}  // namespace

int run_up(const Arguments& arguments) {
  auto line = command_line_of("up");
  Order order;
  line.add("RIG.toml", order.rig_file, "The rig file");
  line.add("--set path=value", order.settings, "A setting that overrides that of the file");
  line.add("--seconds N", order.seconds, "Stops after N seconds", kSomeSeconds);
  line.add("--out DIR", order.out,
           "Where files to be kept go: live.json with the times of all steps, observer.json with "
           "the scores, pictures");
  line.add("--no-keeper", order.no_keeper,
           "Without the process that replaces a dead supervisor; systemd does that for a unit of "
           "install-units");
  line.add("--kept", order.kept, "");
  if (const auto code = line.answered(arguments)) return *code;
  log::never_wait_for_stderr();
  // What the terminal left open is not for the services, and may have the number of a ring.
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  if (!order.kept) warn_of_surroundings();
  order.rig_file = std::filesystem::absolute(order.rig_file);
  if (!order.out.empty()) order.out = std::filesystem::absolute(order.out);
  return order.kept || order.no_keeper ? run(run_options(order)) : keep_up(order);
}

}  // namespace handcast::supervisor
