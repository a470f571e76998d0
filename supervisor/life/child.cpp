// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "ipc/base/clock.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/daemon/words.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/base/spawn.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::int64_t kReportWait_ns = 300'000'000;

/// The prefixes of the environment variables from the keeper and from systemd.
constexpr std::array kNotForServices{kKeeperVariable, "NOTIFY_SOCKET=", "LISTEN_", "WATCHDOG_"};

struct Pipe {
  UniqueFd read, write;
};

/// The arguments, the environment and the descriptors of a new process.
struct Plan {
  std::vector<std::string> arguments, environment;
  std::vector<int> inherited;  ///< descriptors that exec does not close
  Pipe log, ready;
  Pipe turn;  ///< only for a standby
};

tl::unexpected<Error> cannot(std::string_view what) {
  return fail(Errc::unavailable, fmt::format("{}: {}", what, inherited::reason_of(errno)));
}

enum class ReadBy { supervisor, service };

Result<Pipe> open_pipe(ReadBy reader) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return cannot("a pipe to a service");
  if (reader == ReadBy::supervisor) fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return Pipe{UniqueFd(ends[0]), UniqueFd(ends[1])};
}

bool begins_with_any(std::string_view entry, const auto& names) {
  return std::ranges::any_of(names, [&](const char* name) { return entry.starts_with(name); });
}

std::vector<std::string> inherited_environment() {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry; ++entry)
    if (!begins_with_any(*entry, daemon::kHandoverVariables) &&
        !begins_with_any(*entry, kNotForServices))
      environment.emplace_back(*entry);
  return environment;
}

/// Puts the handover into the environment and lets its descriptors be inherited.
void hand_over(const daemon::Handover& handover, int rig_fd, Plan& plan) {
  plan.environment = inherited_environment();
  for (auto& variable : daemon::to_environment(handover))
    plan.environment.push_back(std::move(variable));
  for (const auto& [stream, fd] : handover.rings) plan.inherited.push_back(fd);
  for (const int fd : {handover.ready_fd, handover.standby_fd, handover.state_fd, rig_fd})
    if (fd >= 0) plan.inherited.push_back(fd);
}

Result<Plan> make_plan(const ChildSpec& spec) {
  Plan plan;
  plan.arguments.push_back(spec.program.string());
  plan.arguments.insert(plan.arguments.end(), spec.arguments.begin(), spec.arguments.end());
  if (!spec.rig.empty())
    plan.arguments.insert(
        plan.arguments.end(),
        {daemon::kRigOption,
         daemon::print_mark(
             {.address = spec.rig, .epoch_ns = spec.epoch_ns, .network = daemon::own_network()})});

  auto log = open_pipe(ReadBy::supervisor);
  auto ready = open_pipe(ReadBy::supervisor);
  if (!log || !ready) return tl::make_unexpected(log ? ready.error() : log.error());
  fcntl(log->write.get(), F_SETFL, O_NONBLOCK);  // a full pipe must not block the service
  plan.log = std::move(*log);
  plan.ready = std::move(*ready);

  if (spec.standby) {
    auto turn = open_pipe(ReadBy::service);
    if (!turn) return tl::make_unexpected(turn.error());
    plan.turn = std::move(*turn);
  }
  plan.inherited = spec.kept_open;
  hand_over({.rings = spec.rings,
             .ready_fd = plan.ready.write.get(),
             .standby_fd = plan.turn.read.get(),
             .epoch_ns = spec.epoch_ns,
             .rig = spec.rig,
             .state_fd = spec.state_fd},
            spec.rig_fd, plan);
  return plan;
}

/// The file actions and attributes of posix_spawn().
class SpawnActions {
 public:
  explicit SpawnActions(const Plan& plan) {
    files_.close_input();
    files_.give(plan.log.write.get(), STDOUT_FILENO);
    files_.give(plan.log.write.get(), STDERR_FILENO);
    for (const int fd : plan.inherited) files_.inherit(fd);

    sigset_t none, stops;
    sigemptyset(&none);
    sigemptyset(&stops);
    for (const int number : {SIGINT, SIGTERM}) sigaddset(&stops, number);
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &stops);
    posix_spawnattr_setflags(&attributes_,
                             POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnActions() { posix_spawnattr_destroy(&attributes_); }
  SpawnActions(const SpawnActions&) = delete;

  const posix_spawn_file_actions_t* files() const { return files_.get(); }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  SpawnFiles files_;
  posix_spawnattr_t attributes_;
};

bool is_a_persons_fault(int error) {
  return error == ENOENT || error == EACCES || error == ENOEXEC || error == ENOTDIR;
}

/// posix_spawn() shares the memory of the supervisor until exec, like vfork(). So it does not copy
/// the mappings of the rings, which would take most of the time of a fork().
Result<pid_t> start(Plan& plan) {
  const SpawnActions actions(plan);
  const auto arguments = pointers_to(plan.arguments);
  const auto environment = pointers_to(plan.environment);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, arguments[0], actions.files(), actions.attributes(),
                                arguments.data(), environment.data());
  if (error == 0) return pid;
  return fail(is_a_persons_fault(error) ? Errc::bad_config : Errc::unavailable,
              fmt::format("the program {} cannot be started: {}", plan.arguments[0],
                          inherited::reason_of(error)));
}

}  // namespace

Result<Child> Child::spawn(const ChildSpec& spec) {
  auto plan = make_plan(spec);
  if (!plan) return tl::make_unexpected(plan.error());
  const auto pid = start(*plan);
  if (!pid) return tl::make_unexpected(pid.error());

  Child child;
  child.pid_ = *pid;
  child.pidfd_ = open_pidfd(child.pid_);
  if (!child.pidfd_) return cannot("watching " + spec.program.string());
  child.log_ = std::move(plan->log.read);
  child.ready_ = std::move(plan->ready.read);
  child.turn_ = std::move(plan->turn.write);
  return child;
}

Child Child::adopt(AdoptedProcess process, KeeperLink& keeper) {
  Child child;
  child.pid_ = process.saved.pid;
  child.keeper_ = &keeper;
  child.pidfd_ = std::move(process.pidfd);
  child.log_ = std::move(process.log);
  return child;
}

Child::~Child() {
  if (pid_ <= 0 || reaped_) return;
  if (!pidfd_) ::kill(pid_, SIGKILL);
  signal(SIGKILL);
  if (!keeper_) {
    waitpid(pid_, nullptr, 0);
    return;
  }
  pollfd ended{.fd = pidfd_.get(), .events = POLLIN, .revents = 0};
  poll(&ended, 1, -1);
}

// Uses the pidfd: the pid of an adopted process may have been reused.
void Child::signal(int number) {
  if (!reaped_ && pidfd_) send_signal(pidfd_, number);
}

void Child::give_turn() {
  if (turn_ && daemon::give_turn(turn_.get())) turn_.reset();
}

bool Child::has_ended() const { return supervisor::has_ended(pidfd_); }

std::optional<Exit> Child::try_reap() {
  if (reaped_) return std::nullopt;
  if (keeper_) return try_reap_adopted();
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      info.si_pid == 0)
    return std::nullopt;
  kill(-pid_, SIGKILL);  // before it is reaped: until then the pid cannot be reused
  waitpid(pid_, nullptr, 0);
  reaped_ = true;
  return Exit{.signalled = info.si_code != CLD_EXITED, .code = info.si_status};
}

std::optional<Exit> Child::try_reap_adopted() {
  if (ended_ns_ == 0) {
    if (!has_ended()) return std::nullopt;
    ended_ns_ = now_ns();
    kill(-pid_, SIGKILL);  // the pid was freed only a moment ago
  }
  keeper_->read();
  auto exit = keeper_->take(pid_);
  if (!exit) exit = exit_told_by_kernel(pidfd_.get());
  const bool hopeless = now_ns() - ended_ns_ > kReportWait_ns;
  if (!exit && !hopeless) return std::nullopt;
  reaped_ = true;
  return exit.value_or(Exit{.unknown = true});
}

}  // namespace handcast::supervisor
