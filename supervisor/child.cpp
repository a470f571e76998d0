#include "supervisor/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "ipc/base/clock.hpp"
#include "supervisor/event_loop.hpp"

namespace handcast::supervisor {
namespace {

struct Pipe {
  UniqueFd read, write;
};

/// Everything the child needs, made before the fork.
struct Plan {
  std::vector<std::string> arguments, environment;
  std::vector<int> inherited;  ///< descriptors that exec does not close
  Pipe log, ready;
};

tl::unexpected<Error> cannot(std::string_view what) { return fail(Errc::unavailable, fmt::format("{}: {}", what, std::strerror(errno))); }

Result<Pipe> open_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return cannot("a pipe to a service");
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return Pipe{UniqueFd(ends[0]), UniqueFd(ends[1])};
}

std::vector<std::string> inherited_environment() {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text = *entry;
    const bool ours =
        text.starts_with("HANDCAST_RINGS=") || text.starts_with("HANDCAST_READY_FD=") || text.starts_with("HANDCAST_EPOCH_NS=");
    if (!ours) environment.emplace_back(text);
  }
  return environment;
}

Result<Plan> make_plan(const ChildSpec& spec) {
  Plan plan;
  plan.arguments.push_back(spec.program.string());
  plan.arguments.insert(plan.arguments.end(), spec.arguments.begin(), spec.arguments.end());

  auto log = open_pipe();
  auto ready = open_pipe();
  if (!log || !ready) return tl::make_unexpected(log ? ready.error() : log.error());
  plan.log = std::move(*log);
  plan.ready = std::move(*ready);

  std::string rings;
  for (const auto& [stream, fd] : spec.rings) {
    rings += fmt::format("{}{}={}", rings.empty() ? "" : ",", stream, fd);
    plan.inherited.push_back(fd);
  }
  plan.inherited.push_back(plan.ready.write.get());
  plan.environment = inherited_environment();
  plan.environment.push_back("HANDCAST_RINGS=" + rings);
  plan.environment.push_back(fmt::format("HANDCAST_READY_FD={}", plan.ready.write.get()));
  plan.environment.push_back(fmt::format("HANDCAST_EPOCH_NS={}", spec.epoch_ns));
  return plan;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (auto& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// In the child, between fork and exec.
[[noreturn]] void become(Plan& plan, pid_t supervisor) {
  setsid();
  // For now a daemon goes when its supervisor goes, however it went. This will change once a new supervisor can adopt the
  // daemons of a dead one. The check closes the gap between fork and prctl.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != supervisor) _exit(kExitFailure);

  restore_signals();
  if (const int null = open("/dev/null", O_RDONLY); null >= 0) dup2(null, STDIN_FILENO);
  dup2(plan.log.write.get(), STDOUT_FILENO);
  dup2(plan.log.write.get(), STDERR_FILENO);
  for (const int fd : plan.inherited) fcntl(fd, F_SETFD, 0);

  const auto arguments = pointers_to(plan.arguments);
  const auto environment = pointers_to(plan.environment);
  execve(arguments[0], arguments.data(), environment.data());
  fmt::print(stderr, "{}: {}\n", arguments[0], std::strerror(errno));
  _exit(kExitFailure);
}

}  // namespace

Result<Child> Child::spawn(const ChildSpec& spec) {
  if (access(spec.program.c_str(), X_OK) != 0)
    return fail(Errc::bad_config, fmt::format("there is no program {}: {}", spec.program.string(), std::strerror(errno)));
  auto plan = make_plan(spec);
  if (!plan) return tl::make_unexpected(plan.error());

  Child child;
  const pid_t supervisor = getpid();
  child.pid_ = fork();
  if (child.pid_ < 0) return cannot("starting " + spec.program.string());
  if (child.pid_ == 0) become(*plan, supervisor);

  child.pidfd_ = UniqueFd(static_cast<int>(syscall(SYS_pidfd_open, child.pid_, 0)));
  if (!child.pidfd_) return cannot("watching " + spec.program.string());
  child.log_ = std::move(plan->log.read);
  child.ready_ = std::move(plan->ready.read);
  return child;
}

Child::~Child() {
  if (pid_ <= 0 || reaped_) return;
  signal(SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void Child::signal(int number) {
  if (!reaped_) kill(pid_, number);
}

std::optional<Exit> Child::try_reap() {
  if (reaped_) return std::nullopt;
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0) return std::nullopt;
  kill(-pid_, SIGKILL);  // before the status is taken: until then nobody else can have this number
  waitpid(pid_, nullptr, 0);
  reaped_ = true;
  return Exit{.signalled = info.si_code != CLD_EXITED, .code = info.si_status};
}

Result<std::string> output_of(const std::filesystem::path& program, const std::vector<std::string>& arguments, int limit_ms) {
  auto child = Child::spawn({.program = program, .arguments = arguments});
  if (!child) return tl::make_unexpected(child.error());

  const auto deadline = Deadline::in(std::chrono::milliseconds(limit_ms));
  std::string output;
  std::array<char, 4096> bytes;
  while (!deadline.passed()) {
    pollfd readable{.fd = child->log_fd(), .events = POLLIN};
    poll(&readable, 1, limit_ms);
    const auto count = read(child->log_fd(), bytes.data(), bytes.size());
    if (count == 0) return output;
    if (count > 0) output.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return fail(Errc::unavailable, fmt::format("{} did not answer within {} ms", program.string(), limit_ms));
}

}  // namespace handcast::supervisor
