// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/process_discovery.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/daemon/handover.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/base/process.hpp"

namespace handcast::supervisor {
namespace {

constexpr int kMostSearches = 5;  ///< of looking for services that are left

std::optional<pid_t> pid_in(const std::string& name) {
  pid_t pid = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
  const bool whole = error == std::errc{} && end == name.data() + name.size();
  return whole && pid > 1 ? std::optional(pid) : std::nullopt;
}

/// The value of a variable in an environment as /proc shows it; empty if it is not set.
std::optional<std::string> value_in(std::string_view environment, std::string_view variable) {
  while (!environment.empty()) {
    const auto end = environment.find('\0');
    const auto entry = environment.substr(0, end);
    if (entry.starts_with(variable) && entry.substr(variable.size()).starts_with('='))
      return std::string(entry.substr(variable.size() + 1));
    environment = end == std::string_view::npos ? std::string_view() : environment.substr(end + 1);
  }
  return std::nullopt;
}

/// The number in a variable; -1 if there is none.
std::int64_t number_in(std::string_view environment, std::string_view variable) {
  const auto text = value_in(environment, variable).value_or("");
  std::int64_t number = -1;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// The name of the program; "" if the kernel hides it.
std::string program_of(const std::filesystem::path& process, std::string_view command_line) {
  std::error_code hidden;
  auto program = std::filesystem::read_symlink(process / "exe", hidden);
  if (hidden) program = command_line.substr(0, command_line.find('\0'));
  auto name = program.filename().string();
  if (const auto deleted = name.find(" (deleted)"); deleted != std::string::npos)
    name.resize(deleted);
  return name;
}

/// The instance that --as names on its command line, or else the name of its program.
std::string service_name(const std::filesystem::path& process) {
  constexpr std::string_view kInstance("\0--as\0", 6);
  const auto words = proc_text(process / "cmdline");
  if (const auto option = words.find(kInstance); option != std::string::npos)
    return words.substr(option + kInstance.size()).c_str();
  const auto program = program_of(process, words);
  constexpr std::string_view kPrefix = "handcast-";
  return program.starts_with(kPrefix) ? program.substr(kPrefix.size()) : program;
}

/// The files of a process with capabilities belong to the superuser.
bool is_of_this_user(const std::filesystem::path& process) {
  struct stat status {};
  if (stat(process.c_str(), &status) != 0) return false;
  if (status.st_uid == getuid()) return true;
  const auto users = status_line(process, "Uid");
  return status.st_uid == 0 && users.substr(0, users.find('\t')) == fmt::to_string(getuid());
}

/// Names of rigs belong to a network namespace, but /proc shows the processes of all of them.
bool is_of_this_network(const std::filesystem::path& process) {
  struct stat here {
  }, there{};
  return stat("/proc/self/ns/net", &here) == 0 && stat((process / "ns/net").c_str(), &there) == 0 &&
         here.st_dev == there.st_dev && here.st_ino == there.st_ino;
}

bool is_hidden(const std::filesystem::path& file) {
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  return !fd && (errno == EACCES || errno == EPERM);
}

/// The environment of a process as /proc shows it. It is empty for a moment while the process
/// starts its program (execve), so it is read again then.
std::string environment_of(const std::filesystem::path& process) {
  constexpr int kMostReads = 5;
  std::string environment;
  for (int i = 0; i < kMostReads && environment.empty(); ++i) {
    if (i > 0) usleep(1000);
    environment = proc_text(process / "environ");
  }
  return environment;
}

/// What a process says of its rig. The address is "" if it says nothing.
struct Says {
  std::string address;
  std::int64_t epoch_ns = -1;
  int state_fd = -1;
};

Says said_by_environment(const std::filesystem::path& process) {
  const auto environment = environment_of(process);
  auto address = value_in(environment, daemon::kRigVariable).value_or("");
  if (address.empty() || !is_of_this_network(process)) return {};
  return {std::move(address), number_in(environment, daemon::kEpochVariable),
          static_cast<int>(number_in(environment, daemon::kStateVariable))};
}

Says said_by_command_line(const std::filesystem::path& process) {
  auto mark = daemon::mark_in(proc_text(process / "cmdline"));
  if (!mark || mark->network != daemon::own_network()) return {};
  return {std::move(mark->address), mark->epoch_ns, -1};
}

/// The process is opened before it is examined: from then on it does not matter if its pid is
/// reused.
std::optional<FoundProcess> examine(pid_t pid, const std::filesystem::path& folder) {
  if (!is_of_this_user(folder) || getsid(pid) != pid) return std::nullopt;
  auto pidfd = open_pidfd(pid);
  if (!pidfd || has_ended(pidfd)) return std::nullopt;
  const auto says =
      is_hidden(folder / "environ") ? said_by_command_line(folder) : said_by_environment(folder);
  auto rig = control::name_in(says.address);
  if (rig.empty()) return std::nullopt;
  return FoundProcess{.rig = std::move(rig),
                      .service = service_name(folder),
                      .pid = pid,
                      .pidfd = std::move(pidfd),
                      .epoch_ns = says.epoch_ns,
                      .state_fd = says.state_fd};
}

}  // namespace

std::vector<FoundProcess> find_services() {
  std::vector<FoundProcess> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error))
    if (const auto pid = pid_in(entry.path().filename()))
      if (auto process = examine(*pid, entry.path())) found.push_back(std::move(*process));
  return found;
}

std::vector<FoundProcess> find_services(const std::string& name) {
  auto found = find_services();
  std::erase_if(found, [&](const auto& process) { return process.rig != name; });
  return found;
}

int end_services(const std::string& name, double patience_s, std::int64_t before_ns) {
  std::set<pid_t> ended;
  const auto deadline = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(patience_s)));
  for (int round = 0; round < kMostSearches; ++round) {
    auto found = find_services(name);
    std::erase_if(found, [&](const auto& process) { return process.epoch_ns > before_ns; });
    if (found.empty()) break;
    for (const auto& process : found) send_signal(process.pidfd, SIGTERM);
    for (const auto& process : found) {
      ended.insert(process.pid);
      if (ends_within(process.pidfd, ns_to_seconds(deadline.time_ns() - now_ns()))) continue;
      log::warning("{} (pid {}) does not stop; killed", process.service, process.pid);
      kill_now(process.pid, process.pidfd);
    }
  }
  return static_cast<int>(ended.size());
}

}  // namespace handcast::supervisor
