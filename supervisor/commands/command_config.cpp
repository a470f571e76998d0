// SPDX-License-Identifier: Apache-2.0
// `handcast config`: prints, checks and explains rig files.
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <sstream>

#include "config/measured.hpp"
#include "config/rig.hpp"
#include "config/settings/file_kind.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/daemon/check_word.hpp"
#include "supervisor/base/spawn.hpp"
#include "supervisor/commands/verbs.hpp"
#include "supervisor/spec/catalogue.hpp"
#include "supervisor/spec/fingerprint.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {
namespace {

Catalogue installed_services() { return read_catalogue(catalogue_folder(program_folder())); }

/// What a program printed, and how it ended.
struct CheckOutcome {
  std::string output;
  int exit_code = -1;  ///< -1 if a signal ended it
  int signal = 0;      ///< 0 if it ended itself
};

/// What comes until the end of the file; empty if that is later than the deadline.
std::optional<std::string> read_all(int fd, Deadline deadline) {
  std::string text;
  std::array<char, 4096> part;
  for (;;) {
    const auto left_ns = std::max<std::int64_t>(deadline.time_ns() - now_ns(), 0);
    pollfd readable{.fd = fd, .events = POLLIN, .revents = 0};
    if (poll(&readable, 1, static_cast<int>(ns_to_ms(left_ns))) == 0) return std::nullopt;
    const auto count = ::read(fd, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
}

/// Runs a program and waits for its end. Errors: bad_config (it cannot be started, or does not end
/// in time), unavailable (no descriptors).
Result<CheckOutcome> run_and_read(const std::vector<std::string>& command, double patience_s) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return fail(Errc::unavailable, std::strerror(errno));
  const UniqueFd output(ends[0]);
  UniqueFd input(ends[1]);
  SpawnFiles files;
  files.give(input.get(), STDOUT_FILENO);
  const auto pid = spawn(command, files);
  if (!pid)
    return fail(Errc::bad_config, fmt::format("{}: cannot be started: {}", command.front(),
                                              std::strerror(pid.error())));
  input.reset();
  const auto printed =
      read_all(output.get(), Deadline::in(std::chrono::nanoseconds(seconds_to_ns(patience_s))));
  if (!printed) kill(*pid, SIGKILL);
  CheckOutcome outcome{printed.value_or("")};
  int status = 0;
  while (waitpid(*pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (!printed)
    return fail(Errc::bad_config, fmt::format("{}: its check did not end within {:g} s",
                                              command.front(), patience_s));
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  return outcome;
}

/// The faults in a text, one a line. A line that is indented belongs to the fault before it: the
/// faulty line of a file, and the caret below.
std::vector<std::string> split_faults(const std::string& text) {
  std::vector<std::string> faults;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("    ") && !faults.empty())
      faults.back() += '\n' + line;
    else
      faults.push_back(line);
  return faults;
}

/// The faults that the program of a service finds.
std::vector<std::string> ask(const ServiceSpec& spec, const std::filesystem::path& file,
                             const std::vector<std::string>& settings, double patience_s) {
  const auto& service = spec.name;
  auto command = command_of(spec, program_folder());
  command.insert(command.end(), {"--config", file.string(), "--check"});
  for (const auto& setting : settings) command.insert(command.end(), {"--set", setting});
  const auto outcome = run_and_read(command, patience_s);
  if (!outcome) return {outcome.error().what};
  const bool is_whole = outcome->output.ends_with(daemon::kCheckedWord);
  if (outcome->exit_code == kExitDone && is_whole) return {};
  if (outcome->exit_code == kExitDone)
    return {service +
            ": its check ended before it was done; a library that the rig names may be broken"};
  auto faults = split_faults(outcome->output);
  if (outcome->signal != 0)
    faults.push_back(
        fmt::format("{}: its check was ended by a signal ({}); a library that the rig "
                    "names may be broken",
                    service, strsignal(outcome->signal)));
  if (faults.empty()) faults.push_back(service + ": its check failed without a reason");
  return faults;
}

/// What `up` would refuse about a rig that was read from `file` with these settings of --set: a
/// sentence for each fault. Asks the program of each service (`handcast-NAME --check`), which opens
/// what the rig names.
std::vector<std::string> faults_of(const config::Rig& rig, const std::filesystem::path& file,
                                   const std::vector<std::string>& settings) {
  const auto catalogue = installed_services();
  std::vector<std::string> faults;
  // Several services may name one fault, some after their own name.
  const auto is_known = [&](const std::string& fault) {
    return std::ranges::any_of(faults, [&](const std::string& known) {
      return known.ends_with(fault) || fault.ends_with(known);
    });
  };
  for (const auto& service : services_of(rig, catalogue)) {
    const auto known = service.backend.empty()
                           ? Result<void>()
                           : check_backend(catalogue, service.name, service.backend);
    if (!known) faults.push_back(fmt::format("{}.backend: {}", service.name, known.error().what));
    if (!known) continue;
    for (auto& fault : ask(service, file, settings, rig.supervisor.ready_s))
      if (!is_known(fault)) faults.push_back(std::move(fault));
  }
  return faults;
}

/// Prints what `up` would refuse about a rig.
int check(const config::Rig& rig, const std::string& file,
          const std::vector<std::string>& settings) {
  const auto faults = faults_of(rig, file, settings);
  if (!faults.empty())
    return complain(kExitConfig, fmt::format("{}:\n{}", file, join(faults, "\n")));
  for (const auto& note : idle_settings(rig, installed_services(), settings))
    fmt::print("note: {}\n", printable(note));
  fmt::print("{} is in order\n", file);
  return kExitDone;
}

/// Prints as comments where values come from that are not those of the rig file.
void print_measured(const std::filesystem::path& rig_file) {
  const auto file = config::measured_file_of(rig_file);
  const auto settings = config::read_measured(file);
  if (!settings || settings->empty()) return;
  fmt::print("# {} sets:\n", file.string());
  for (const auto& [path, value] : *settings) fmt::print("#   {} = {}\n", path, value);
}

}  // namespace

int run_config(const Arguments& arguments) {
  auto line = command_line_of("config");
  std::string file;
  std::vector<std::string> settings;
  bool prints = false, checks = false, explains = false;
  line.add("[FILE]", file, "The rig file");
  line.add("--print", prints, "All settings, with defaults where FILE has none");
  line.add("--check", checks,
           "What `handcast up` would refuse: settings, back ends, and the files that the services "
           "open; devices, outputs and ports are not opened");
  line.add("--reference", explains, "The page config/REFERENCE.md");
  line.add("--set path=value", settings, "A setting that overrides that of the file");
  if (const auto code = line.answered(arguments)) return *code;
  if (explains) {
    fmt::print("{}{}", config::print_reference(), print_backends(installed_services()));
    return kExitDone;
  }
  if (prints == checks) return line.refuse("one of --print, --check, --reference is needed");
  if (checks && file.empty()) return line.refuse("--check needs a file");

  const auto rig =
      file.empty() ? config::parse_rig("", std::filesystem::current_path() / "defaults", settings)
                   : config::load_rig(file, settings);
  if (!rig) return complain(rig.error());
  if (auto why = config::why_unreadable(config::print_rig(*rig)); !why.empty())
    return complain({Errc::bad_config, std::move(why)});
  if (checks) return check(*rig, file, settings);
  if (!file.empty()) print_measured(file);
  fmt::print("{}", config::print_rig(*rig));
  return kExitDone;
}

}  // namespace handcast::supervisor
