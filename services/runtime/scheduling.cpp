// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/scheduling.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <thread>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::service {
namespace {

using Note = std::optional<std::string>;

/// The cores must be there.
Note use_cores(const std::vector<double>& cores, std::string_view service) {
  if (cores.empty()) return {};
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const double core : cores) CPU_SET(static_cast<int>(core), &set);
  if (sched_setaffinity(0, sizeof set, &set) == 0) return {};
  return fmt::format(
      "{}.process.cores: the process runs on all cores, the wanted ones are denied: {}", service,
      std::strerror(errno));
}

Note use_priority(int priority, std::string_view service) {
  if (priority == 0) return {};
  const auto denied = try_priority(priority);
  if (denied.empty()) return {};
  return fmt::format(
      "{}.process.priority: the process runs at normal priority, real time needs CAP_SYS_NICE or "
      "an rtprio limit of {}: {}",
      service, priority, denied);
}

bool may_lock_all_memory() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};
  return syscall(SYS_capget, &header, data.data()) == 0 &&
         (data[0].effective & (1u << CAP_IPC_LOCK)) != 0;
}

// If the memory lock is limited, it could succeed now and make a later allocation fail. So the
// memory is only locked without a limit.
Note lock_memory(bool wanted, std::string_view service) {
  if (!wanted) return {};
  errno = EPERM;
  if (may_lock_all_memory() && mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return fmt::format(
      "{}.process.lock_memory: the memory is not locked, which needs CAP_IPC_LOCK or no memlock "
      "limit: {}",
      service, std::strerror(errno));
}

/// The kernel takes one such change in 100 ms from all processes without rights.
bool lower_session(int nice) {
  using namespace std::chrono_literals;
  const UniqueFd file(::open("/proc/self/autogroup", O_WRONLY | O_CLOEXEC));
  if (!file) return errno == ENOENT;  // a kernel without autogroups
  const auto text = std::to_string(nice);
  for (const auto until = Deadline::in(2s); ::write(file.get(), text.data(), text.size()) < 0;) {
    if (errno != EAGAIN || until.passed()) return false;
    std::this_thread::sleep_for(10ms);
  }
  return true;
}

}  // namespace

std::string try_priority(int priority) {
  const sched_param parameters{.sched_priority = priority};
  return sched_setscheduler(0, SCHED_FIFO, &parameters) == 0 ? "" : std::strerror(errno);
}

Result<void> check_scheduling(const config::Process& process, std::string_view service) {
  const auto there_are = sysconf(_SC_NPROCESSORS_CONF);
  for (const double core : process.cores)
    if (core != std::floor(core) || core < 0 || core >= static_cast<double>(there_are))
      return fail(
          Errc::bad_config,
          fmt::format("{}.process.cores: there is no core {:g}; this machine has cores 0 to {}",
                      service, core, there_are - 1));
  return {};
}

Result<std::vector<std::string>> apply_scheduling(const config::Process& process,
                                                  std::string_view service) {
  if (const auto possible = check_scheduling(process, service); !possible)
    return tl::make_unexpected(possible.error());
  std::vector<std::string> notes;
  for (auto& note : {use_cores(process.cores, service), use_priority(process.priority, service),
                     lock_memory(process.lock_memory, service)})
    if (note) notes.push_back(*note);
  return notes;
}

void give_way() {
  constexpr int kNice = 10;
  if (::nice(kNice) == -1) log::debug("the priority cannot be lowered");
  if (::getsid(0) == ::getpid() && !lower_session(kNice))
    log::debug("the priority of the session cannot be lowered: {}", std::strerror(errno));
}

}  // namespace handcast::service
