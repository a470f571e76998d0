// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/adoption.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/control/runtime_folder.hpp"
#include "ipc/ring/row_owner.hpp"
#include "supervisor/base/process.hpp"
#include "supervisor/succession/systemd.hpp"

namespace handcast::supervisor {
namespace {

/// Rings from systemd's store, by stream.
using Stored = std::vector<std::pair<std::string, UniqueFd>>;

// Opens the pidfd before it compares the start time: from then on it does not matter if the pid is
// reused.
UniqueFd pidfd_of(const SavedService& saved) {
  if (saved.pid == 0) return {};
  UniqueFd pidfd(static_cast<int>(syscall(SYS_pidfd_open, saved.pid, 0)));
  if (pidfd && start_ticks_of(saved.pid) == saved.started_ticks) return pidfd;
  return {};
}

std::vector<AdoptedProcess> living_of(const SavedRig& saved) {
  std::vector<AdoptedProcess> living;
  for (const auto& service : saved.services)
    if (auto pidfd = pidfd_of(service)) living.push_back({service, std::move(pidfd), {}});
  return living;
}

void send_signal(const AdoptedProcess& process, int number) {
  syscall(SYS_pidfd_send_signal, process.pidfd.get(), number, nullptr, 0);
}

bool ends_before(const AdoptedProcess& process, Deadline deadline) {
  pollfd ended{.fd = process.pidfd.get(), .events = POLLIN, .revents = 0};
  const auto left_ns = std::max<std::int64_t>(deadline.time_ns() - now_ns(), 0);
  return poll(&ended, 1, static_cast<int>(ns_to_ms(left_ns)) + 1) == 1;
}

/// Kills a process and its process group. The process was alive a moment ago, so its pid has not
/// been reused.
void kill_now(const AdoptedProcess& process) {
  kill(-process.saved.pid, SIGKILL);
  send_signal(process, SIGKILL);
  ends_before(process, Deadline::in(std::chrono::seconds(1)));
}

bool is_inode(int fd, std::uint64_t inode) {
  struct stat status {};
  return fd >= 0 && fstat(fd, &status) == 0 && status.st_ino == inode;
}

/// Opens the memory of a ring as a new open file, which shares no locks with that of the service.
Result<UniqueFd> reopen(const SavedRing& ring, const std::vector<AdoptedProcess>& living,
                        const Stored& stored) {
  std::string reason = "no living process has it";
  for (const auto& process : living) {
    const auto file = fmt::format("/proc/{}/fd/{}", process.saved.pid, ring.fd);
    UniqueFd fd(::open(file.c_str(), O_RDWR | O_CLOEXEC));
    if (is_inode(fd.get(), ring.inode)) return fd;
    reason = fmt::format("{}: {}", file, fd ? "that is another file" : std::strerror(errno));
  }
  for (const auto& [stream, fd] : stored)
    if (stream == ring.stream && is_inode(fd.get(), ring.inode))
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
                                             const std::vector<AdoptedProcess>& living,
                                             const Stored& stored) {
  int above_all = 3;  // a number that no ring needs
  for (const auto& ring : saved.rings) above_all = std::max(above_all, ring.fd + 1);

  std::vector<UniqueFd> memories;
  for (const auto& ring : saved.rings) {
    auto memory = reopen(ring, living, stored);
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

/// Opens the reading end of a service's output again. The output in between is lost.
UniqueFd reopen_log(pid_t pid) {
  return UniqueFd(
      ::open(fmt::format("/proc/{}/fd/1", pid).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
}

/// Kills the services that were not ready, because they can no longer report it: their pipe is
/// closed. Returns the others.
std::vector<AdoptedProcess> keep_the_ready(std::vector<AdoptedProcess> living) {
  std::vector<AdoptedProcess> ready;
  for (auto& process : living) {
    if (process.saved.state != State::ready) {
      log::info("{} was not ready when its supervisor died; it is started again",
                process.saved.name);
      kill_now(process);
      continue;
    }
    process.log = reopen_log(process.saved.pid);
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

}  // namespace

Result<ipc::Segment> make_ring(const ipc::RingSpec& spec) {
  constexpr int kFirstNumber = 100;  // a supervisor has some 40 descriptors of its own
  const auto made = ipc::Segment::create(spec);
  if (!made) return tl::make_unexpected(made.error());
  UniqueFd fd(fcntl(made->fd(), F_DUPFD_CLOEXEC, kFirstNumber));
  if (!fd)
    return fail(Errc::unavailable,
                fmt::format("no descriptor from {} on: {}", kFirstNumber, std::strerror(errno)));
  return ipc::Segment::open(std::move(fd));
}

Result<std::optional<AdoptedRig>> adopt(const std::string& name) {
  const auto stored = taken_from_systemd();
  auto saved = load_saved(name);
  if (!saved) return tl::make_unexpected(saved.error());
  if (!*saved) return std::nullopt;

  auto living = living_of(**saved);
  if (living.empty() && stored.empty()) return std::nullopt;
  auto rings = take_rings(**saved, living, stored);
  if (!rings && living.empty())
    return std::nullopt;  // systemd did not keep all of them, but they are not in use
  if (!rings)
    return fail(
        rings.error().code,
        fmt::format(
            "services of rig '{}' run without a supervisor and cannot be taken over: {}: {}; "
            "`handcast down --rig {}` stops them",
            name, names_of(living), rings.error().what, name));
  return AdoptedRig{std::move(**saved), std::move(*rings), keep_the_ready(std::move(living))};
}

int stop_orphans(const std::string& name, double stop_s) {
  const auto saved = load_saved(name);
  if (!saved || !*saved) return 0;
  const auto living = living_of(**saved);
  std::for_each(living.rbegin(), living.rend(),
                [](const auto& process) { send_signal(process, SIGTERM); });
  const auto deadline = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(stop_s)));
  for (const auto& process : living) {
    if (ends_before(process, deadline)) continue;
    log::warning("{} does not stop; killed", process.saved.name);
    kill_now(process);
  }
  forget_saved(name);
  return static_cast<int>(living.size());
}

std::vector<std::string> orphaned_rigs() {
  std::vector<std::string> rigs;
  const auto folder = control::runtime_folder();
  std::error_code error;
  if (!folder) return rigs;
  for (const auto& entry : std::filesystem::directory_iterator(*folder, error)) {
    if (entry.path().extension() != ".state") continue;
    const auto name = entry.path().stem().string();
    const auto socket = control::socket_of(name);
    const bool has_supervisor =
        socket && (control::connect_to(*socket) ||
                   control::connect_to(*socket).error().code == Errc::timeout);
    const auto saved = load_saved(name);
    if (!has_supervisor && saved && *saved && !living_of(**saved).empty()) rigs.push_back(name);
  }
  std::ranges::sort(rigs);
  return rigs;
}

std::optional<std::string> abandoned_rig(const std::string& name) {
  for (const auto limit = Deadline::in(std::chrono::seconds(1));; usleep(50'000)) {
    auto rigs = orphaned_rigs();
    if (!name.empty()) std::erase_if(rigs, [&](const auto& rig) { return rig != name; });
    const auto living = control::living_rigs();
    if (rigs.size() != 1 || (name.empty() && living && !living->empty())) return std::nullopt;
    if (limit.passed()) return rigs.front();
  }
}

}  // namespace handcast::supervisor
