// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/adoption.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/ring/row_owner.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/base/process.hpp"
#include "supervisor/succession/systemd.hpp"

namespace handcast::supervisor {
namespace {

/// Descriptors from systemd's store, by name.
using Stored = std::vector<std::pair<std::string, UniqueFd>>;

/// The saved services that live. Takes their processes out of `found`.
std::vector<AdoptedProcess> living_of(const SavedRig& saved, std::vector<FoundProcess>& found) {
  std::vector<AdoptedProcess> living;
  for (const auto& service : saved.services) {
    const auto process = std::ranges::find(found, service.pid, &FoundProcess::pid);
    if (process == found.end() || start_ticks_of(service.pid) != service.started_ticks) continue;
    living.push_back({service, std::move(process->pidfd), {}});
    found.erase(process);
  }
  return living;
}

/// The processes that may have the rings open: the living services first.
std::vector<pid_t> holders_in(const std::vector<AdoptedProcess>& living,
                              const std::vector<FoundProcess>& others) {
  std::vector<pid_t> holders;
  for (const auto& process : living) holders.push_back(process.saved.pid);
  for (const auto& process : others) holders.push_back(process.pid);
  return holders;
}

/// Opens the memory of a ring as a new open file, which shares no locks with that of the service.
Result<UniqueFd> reopen(const SavedRing& ring, const std::vector<pid_t>& holders,
                        const Stored& stored) {
  std::string reason = "no living process has it";
  for (const auto pid : holders) {
    const auto file = fmt::format("/proc/{}/fd/{}", pid, ring.fd);
    UniqueFd fd(::open(file.c_str(), O_RDWR | O_CLOEXEC));
    if (fd && inode_of(fd.get()) == ring.inode) return fd;
    reason = fmt::format("{}: {}", file, fd ? "that is another file" : std::strerror(errno));
  }
  for (const auto& [stream, fd] : stored)
    if (stream == ring.stream && inode_of(fd.get()) == ring.inode)
      return UniqueFd(fcntl(fd.get(), F_DUPFD_CLOEXEC, 3));
  return fail(Errc::unavailable,
              fmt::format("ring '{}' cannot be opened ({})", ring.stream, reason));
}

/// Moves a descriptor to the number that the services know, because children inherit rings by
/// number.
Result<UniqueFd> place(UniqueFd fd, int number) {
  if (fd.get() == number) return fd;
  if (fcntl(number, F_GETFD) != -1)
    return fail(Errc::unavailable,
                fmt::format("descriptor {} is needed for a ring, but is in use", number));
  if (dup3(fd.get(), number, O_CLOEXEC) != number)
    return fail(Errc::unavailable, fmt::format("descriptor {}: {}", number, std::strerror(errno)));
  return UniqueFd(number);
}

Result<std::vector<ipc::Segment>> take_rings(const SavedRig& saved,
                                             const std::vector<pid_t>& holders,
                                             const Stored& stored) {
  int above_all = 3;  // a number that no ring needs
  for (const auto& ring : saved.rings) above_all = std::max(above_all, ring.fd + 1);

  std::vector<UniqueFd> memories;
  for (const auto& ring : saved.rings) {
    auto memory = reopen(ring, holders, stored);
    if (!memory) return tl::make_unexpected(memory.error());
    memories.emplace_back(fcntl(memory->get(), F_DUPFD_CLOEXEC, above_all));
    if (!memories.back())
      return fail(Errc::unavailable,
                  fmt::format("ring '{}': {}", ring.stream, std::strerror(errno)));
  }
  std::vector<ipc::Segment> rings;
  for (std::size_t i = 0; i < memories.size(); ++i) {
    auto fd = place(std::move(memories[i]), saved.rings[i].fd);
    if (!fd) return tl::make_unexpected(fd.error());
    auto segment = ipc::Segment::open(std::move(*fd));
    if (!segment) return fail_in(fmt::format("ring '{}'", saved.rings[i].stream), segment.error());
    ipc::sweep_dead_rows(*segment);
    rings.push_back(std::move(*segment));
  }
  return rings;
}

/// The descriptor of a process for the file with this inode, as a path; "" if it has none.
std::filesystem::path descriptor_of(pid_t pid, std::uint64_t inode) {
  std::error_code hidden;
  for (auto entry = std::filesystem::directory_iterator(fmt::format("/proc/{}/fd", pid), hidden);
       !hidden && entry != std::filesystem::directory_iterator(); entry.increment(hidden)) {
    struct stat status {};
    if (stat(entry->path().c_str(), &status) == 0 && status.st_ino == inode) return entry->path();
  }
  return {};
}

/// Opens the reading end of a service's output again. The output in between is lost. If the service
/// hides its descriptors, `others` may have that end.
UniqueFd reopen_log(const SavedService& service, const std::vector<FoundProcess>& others) {
  constexpr int kHow = O_RDONLY | O_NONBLOCK | O_CLOEXEC;
  UniqueFd log(::open(fmt::format("/proc/{}/fd/1", service.pid).c_str(), kHow));
  for (const auto& other : others)
    if (!log && service.log_inode != 0)
      log = UniqueFd(::open(descriptor_of(other.pid, service.log_inode).c_str(), kHow));
  return log;
}

/// Kills the services that were not ready, because they can no longer report it: their pipe is
/// closed. Returns the others.
std::vector<AdoptedProcess> keep_the_ready(std::vector<AdoptedProcess> living,
                                           const std::vector<FoundProcess>& others) {
  std::vector<AdoptedProcess> ready;
  for (auto& process : living) {
    if (process.saved.state != State::ready) {
      log::info("{} was not ready when its supervisor died; it is started again",
                process.saved.name);
      kill_now(process.saved.pid, process.pidfd);
      continue;
    }
    process.log = reopen_log(process.saved, others);
    ready.push_back(std::move(process));
  }
  return ready;
}

std::string names_of(const std::vector<AdoptedProcess>& processes) {
  std::string names;
  for (const auto& process : processes)
    names += fmt::format("{}{} (pid {})", names.empty() ? "" : ", ", process.saved.name,
                         process.saved.pid);
  return names;
}

std::string names_of(const std::vector<FoundProcess>& processes) {
  std::string names;
  for (const auto& process : processes)
    names += fmt::format("{}{} (pid {})", names.empty() ? "" : ", ", process.service, process.pid);
  return names;
}

void kill_all(const std::vector<FoundProcess>& processes) {
  for (const auto& process : processes) kill_now(process.pid, process.pidfd);
}

/// The state that services hold open, or that systemd has stored. Empty if none can be read.
std::optional<std::pair<StateMemory, SavedRig>> readable_state(
    const std::string& name, const std::vector<FoundProcess>& found, const Stored& stored) {
  const auto read =
      [&](Result<StateMemory> memory) -> std::optional<std::pair<StateMemory, SavedRig>> {
    if (!memory) return std::nullopt;
    auto saved = memory->load(name);
    if (!saved) return std::nullopt;
    return std::pair(std::move(*memory), std::move(*saved));
  };
  for (const auto& process : found)
    if (auto state = read(state_memory_of(process))) return state;
  for (const auto& [stored_name, fd] : stored)
    if (stored_name == kStateName)
      if (auto state = read(StateMemory::open(UniqueFd(fcntl(fd.get(), F_DUPFD_CLOEXEC, 3)))))
        return state;
  return std::nullopt;
}

}  // namespace

Result<ipc::Segment> make_ring(const ipc::RingSpec& spec) {
  constexpr int kFirstNumber = 100;  // a supervisor has some 40 descriptors of its own
  const auto made = ipc::Segment::create(spec);
  if (!made) return tl::make_unexpected(made.error());
  UniqueFd fd(fcntl(made->fd(), F_DUPFD_CLOEXEC, kFirstNumber));
  if (!fd)
    return fail(
        Errc::unavailable,
        fmt::format("no file descriptor from {} on is free ({}); a rig needs a limit of at least "
                    "{} (ulimit -n)",
                    kFirstNumber, std::strerror(errno), 2 * kFirstNumber));
  return ipc::Segment::open(std::move(fd));
}

Result<std::optional<AdoptedRig>> adopt(const std::string& name) {
  const auto stored = taken_from_systemd();
  auto found = find_services(name);
  auto state = readable_state(name, found, stored);
  if (!state) {
    if (!found.empty())
      log::warning(
          "{} of rig '{}' cannot be taken over, because no saved state can be read; "
          "killed and started anew",
          names_of(found), name);
    kill_all(found);
    return std::nullopt;
  }
  auto& [memory, saved] = *state;
  auto living = living_of(saved, found);
  auto rings = take_rings(saved, holders_in(living, found), stored);
  if (!rings && !living.empty())
    return fail(
        rings.error().code,
        fmt::format(
            "services of rig '{}' run without a supervisor and cannot be taken over: {}: {}; "
            "`handcast down --rig {}` stops them",
            name, names_of(living), rings.error().what, name));
  auto ready = keep_the_ready(std::move(living), found);
  kill_all(found);
  if (!rings) return std::nullopt;  // systemd did not keep all of them, but they are not in use
  return AdoptedRig{std::move(saved), std::move(memory), std::move(*rings), std::move(ready)};
}

Result<StateMemory> state_memory_of(const FoundProcess& service) {
  const auto file = fmt::format("/proc/{}/fd/{}", service.pid, service.state_fd);
  return StateMemory::open(UniqueFd(::open(file.c_str(), O_RDWR | O_CLOEXEC)));
}

std::vector<std::string> rigs_with_services() {
  std::set<std::string> rigs;
  for (const auto& process : find_services()) rigs.insert(process.rig);
  return {rigs.begin(), rigs.end()};
}

std::vector<std::string> orphaned_rigs() {
  auto rigs = rigs_with_services();
  std::erase_if(rigs, control::has_supervisor);
  return rigs;
}

std::optional<SavedRig> state_of(const std::string& name) {
  auto state = readable_state(name, find_services(name), {});
  return state ? std::optional(std::move(state->second)) : std::nullopt;
}

}  // namespace handcast::supervisor
