// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/keeper.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/unique_fd.hpp"
#include "supervisor/base/console.hpp"
#include "supervisor/base/exit.hpp"
#include "supervisor/life/exit_reports.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::array kStopSignals{SIGINT, SIGTERM, SIGHUP};
constexpr std::int64_t kShortLife_ns = 1'000'000'000;
constexpr std::int64_t kFirstPause_ns = 50'000'000;
constexpr std::int64_t kMinute_ns = 60'000'000'000;
constexpr int kDeathsInAMinute = 10;
/// How long the keeper waits for the remaining children after the supervisor has exited.
constexpr std::int64_t kFarewell_ns = 1'000'000'000;

/// The deaths of the supervisor.
class Deaths {
 public:
  void add(std::int64_t started_ns, std::int64_t died_ns) {
    recent_ns_[count_++ % recent_ns_.size()] = died_ns;
    short_lives_ = died_ns - started_ns < kShortLife_ns ? short_lives_ + 1 : 0;
  }
  bool too_many(std::int64_t now) const {
    return std::ranges::count_if(recent_ns_, [&](std::int64_t died_ns) {
             return died_ns > 0 && now - died_ns < kMinute_ns;
           }) == kDeathsInAMinute;
  }
  /// The wait before the next start; 0 unless at least two lives in a row were short.
  std::int64_t pause_ns() const {
    return short_lives_ < 2 ? 0 : kFirstPause_ns << (std::min(short_lives_, 6) - 2);
  }

 private:
  std::array<std::int64_t, kDeathsInAMinute> recent_ns_{};
  std::size_t count_ = 0;
  int short_lives_ = 0;
};

/// The arguments and the environment of the supervisor. They are built once, so that later starts
/// do not allocate memory.
struct Plan {
  std::vector<std::string> arguments, environment;
  std::vector<char*> argument_pointers, environment_pointers;
  std::string successor = fmt::format("{}=1", kSuccessorVariable);

  Plan(const std::vector<std::string>& command, int report_fd) : arguments(command) {
    for (char** entry = environ; *entry; ++entry) {
      const std::string_view text = *entry;
      if (!text.starts_with(fmt::format("{}=", kKeeperVariable)) &&
          !text.starts_with(fmt::format("{}=", kSuccessorVariable)))
        environment.emplace_back(text);
    }
    environment.push_back(fmt::format("{}={}", kKeeperVariable, report_fd));
    for (auto& text : arguments) argument_pointers.push_back(text.data());
    for (auto& text : environment) environment_pointers.push_back(text.data());
    argument_pointers.push_back(nullptr);
    environment_pointers.insert(environment_pointers.end(),
                                {nullptr, nullptr});  // a place for kSuccessorVariable
  }
  void for_a_successor() {
    environment_pointers[environment_pointers.size() - 2] = successor.data();
  }
};

class Keeper {
 public:
  Keeper(const std::vector<std::string>& arguments, UniqueFd here, UniqueFd there)
      : here_(std::move(here)), there_(std::move(there)), plan_(arguments, there_.get()) {}

  int run() {
    prepare();
    for (;;) {
      const auto started_ns = now_ns();
      start();
      while (supervisor_ > 0) handle(wait_for_signal(kMinute_ns));
      const bool cannot_now = is_successor_ && exit_ && exit_->code == kExitRetry;
      if (exit_ && !exit_->signalled && !cannot_now) return see_off(exit_->code);
      deaths_.add(started_ns, now_ns());
      if (deaths_.too_many(now_ns())) return give_up();
      const auto pause_ns = deaths_.pause_ns();
      log::warning("the supervisor died ({}); started again{}",
                   exit_ ? exit_->describe() : "no process could be created",
                   pause_ns > 0 ? fmt::format(" after {:.0f} ms", ns_to_ms(pause_ns)) : "");
      for (const auto until_ns = now_ns() + pause_ns; now_ns() < until_ns;)
        handle(wait_for_signal(until_ns - now_ns()));
      plan_.for_a_successor();
      is_successor_ = true;
    }
  }

 private:
  void prepare() {
    prctl(PR_SET_NAME, "handcast-keeper");
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    signal(SIGCHLD, SIG_DFL);
    signal(SIGPIPE, SIG_IGN);
    sigemptyset(&stop_signals_);
    for (const int number : kStopSignals) sigaddset(&stop_signals_, number);
    awaited_ = stop_signals_;
    sigaddset(&awaited_, SIGCHLD);
    sigprocmask(SIG_BLOCK, &awaited_, nullptr);
  }

  void start() {
    exit_.reset();
    supervisor_ = fork();
    if (supervisor_ == 0) become_supervisor();
    if (supervisor_ < 0) return;
    setpgid(supervisor_, supervisor_);  // both processes do this, because either may run first
    for (const int number : kStopSignals)
      if (sigismember(&received_, number) == 1) kill(supervisor_, number);
  }

  // The stop signals stay blocked across exec, so that an early one stays pending until the
  // supervisor reads it.
  [[noreturn]] void become_supervisor() {
    setpgid(0, 0);
    signal(SIGTTOU, SIG_IGN);  // it writes to the terminal as a background process
    sigset_t children;
    sigemptyset(&children);
    sigaddset(&children, SIGCHLD);
    sigprocmask(SIG_UNBLOCK, &children, nullptr);
    fcntl(there_.get(), F_SETFD, 0);
    execve(plan_.argument_pointers[0], plan_.argument_pointers.data(),
           plan_.environment_pointers.data());
    print_line(fmt::format("handcast: {}: {}", plan_.arguments[0], std::strerror(errno)));
    _exit(kExitRetry);
  }

  /// The number of a signal that arrived; 0 if none did within `span_ns`.
  int wait_for_signal(std::int64_t span_ns) const {
    const timespec span{span_ns / 1'000'000'000, span_ns % 1'000'000'000};
    return std::max(sigtimedwait(&awaited_, nullptr, &span), 0);
  }

  void handle(int signal_number) {
    if (signal_number == SIGCHLD) return reap();
    if (signal_number == 0) return;
    sigaddset(&received_, signal_number);
    if (supervisor_ > 0) kill(supervisor_, signal_number);
  }

  /// Reaps all children that have ended. Stores the end of the supervisor, reports the others.
  void reap() {
    for (siginfo_t info{}; waitid(P_ALL, 0, &info, WEXITED | WNOHANG) == 0 && info.si_pid != 0;
         info = {}) {
      if (info.si_pid == supervisor_) {
        exit_ = Exit{.signalled = info.si_code != CLD_EXITED, .code = info.si_status};
        supervisor_ = -1;
        continue;
      }
      const ExitReport report{info.si_pid, info.si_code, info.si_status};
      send(here_.get(), &report, sizeof report,
           MSG_DONTWAIT | MSG_NOSIGNAL);  // lost if the queue is full
    }
  }

  bool has_children() const {
    siginfo_t info{};
    return waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0;
  }

  int see_off(int exit_code) {
    for (const auto limit = Deadline::in(std::chrono::nanoseconds(kFarewell_ns));
         has_children() && !limit.passed();) {
      wait_for_signal(kFarewell_ns / 20);
      reap();
    }
    return exit_code;
  }

  int give_up() const {
    print_line(
        fmt::format("handcast: the supervisor died {} times within a minute and is not started "
                    "again; its services continue to run: "
                    "`handcast up` takes them over, `handcast down` stops them",
                    kDeathsInAMinute));
    return kExitRetry;
  }

  UniqueFd here_;  ///< the keeper's end of the socket pair for reports
  /// The supervisor's end. The keeper holds it open, so that no report is lost between two
  /// supervisors.
  UniqueFd there_;
  Plan plan_;
  Deaths deaths_;
  sigset_t stop_signals_{}, awaited_{};
  /// The stop signals received so far. A successor gets them, too, because the rig still has to be
  /// stopped.
  sigset_t received_{};
  pid_t supervisor_ = -1;
  bool is_successor_ = false;  ///< the present supervisor follows one that died
  std::optional<Exit> exit_;
};

}  // namespace

int keep(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    print_line(
        fmt::format("handcast: the keeper's socket cannot be created: {}", std::strerror(errno)));
    return kExitRetry;
  }
  return Keeper(arguments, UniqueFd(ends[0]), UniqueFd(ends[1])).run();
}

}  // namespace handcast::supervisor
