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
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/unique_fd.hpp"
#include "supervisor/base/console.hpp"
#include "supervisor/base/exit.hpp"
#include "supervisor/life/keeper_link.hpp"
#include "supervisor/succession/process_discovery.hpp"
#include "supervisor/succession/supervisor_command.hpp"

namespace handcast::supervisor {
namespace {

/// The deaths of the supervisors of one keeper.
class SupervisorDeaths {
 public:
  static constexpr int kDeathsInAMinute = 10;  ///< after which no supervisor is started again

  /// Adds a death. Times are CLOCK_MONOTONIC.
  void add(std::int64_t started_ns, std::int64_t died_ns) {
    recent_ns_[count_++ % recent_ns_.size()] = died_ns;
    short_lives_ = died_ns - started_ns < kShortLife_ns ? short_lives_ + 1 : 0;
  }
  /// True if there were kDeathsInAMinute within the last minute.
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
  static constexpr std::int64_t kShortLife_ns = 1'000'000'000;  ///< a failed start is shorter
  static constexpr std::int64_t kFirstPause_ns = 50'000'000;
  static constexpr std::int64_t kMinute_ns = 60'000'000'000;

  std::array<std::int64_t, kDeathsInAMinute> recent_ns_{};
  std::size_t count_ = 0;
  int short_lives_ = 0;
};

constexpr std::array kStopSignals{SIGINT, SIGTERM, SIGHUP};
/// The longest time between two looks at signals and beats.
constexpr std::int64_t kLook_ns = 100'000'000;
/// If two looks are further apart, the keeper itself stood still.
constexpr std::int64_t kStoodStill_ns = 500'000'000;
/// The longest time without a beat, and before the first one.
/// @{
constexpr std::int64_t kLongestSilence_ns = 2'000'000'000;
constexpr std::int64_t kFirstBeat_ns = 30'000'000'000;
/// @}
/// The supervisor is killed when the same stop signal has come this often.
constexpr int kImpatient = 3;
/// The time that services get to stop without a supervisor.
constexpr double kServices_s = 1;
/// How long the keeper waits for the remaining children after the supervisor has exited.
constexpr std::int64_t kFarewell_ns = 1'000'000'000;

class Keeper {
 public:
  Keeper(const std::vector<std::string>& arguments, UniqueFd here, UniqueFd there)
      : here_(std::move(here)), there_(std::move(there)), command_(arguments, there_.get()) {}

  int run() {
    prepare();
    for (;;) {
      const auto started_ns = now_ns();
      start();
      while (supervisor_ > 0) look(kLook_ns);
      if (exit_ && !exit_->signalled && !cannot_take_over()) return see_off(exit_->code);
      deaths_.add(started_ns, now_ns());
      if (must_stop_the_rig()) return stop_the_rig();
      if (deaths_.too_many(now_ns())) return give_up();
      const auto pause_ns = deaths_.pause_ns();
      log::warning("the supervisor died ({}); started again{}",
                   exit_ ? exit_->describe() : "no process could be created",
                   pause_ns > 0 ? fmt::format(" after {:.0f} ms", ns_to_ms(pause_ns)) : "");
      for (const auto until_ns = now_ns() + pause_ns; now_ns() < until_ns && !must_stop_the_rig();)
        look(until_ns - now_ns());
      if (must_stop_the_rig()) return stop_the_rig();
      command_.for_a_successor();
      is_successor_ = true;
    }
  }

 private:
  void prepare() {
    prctl(PR_SET_NAME, kKeeperName);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    signal(SIGCHLD, SIG_DFL);
    signal(SIGPIPE, SIG_IGN);
    sigemptyset(&awaited_);  // a signal that is blocked arrives even if it is ignored
    for (const int number : kStopSignals)
      if (!inherited::is_ignored(number)) sigaddset(&awaited_, number);
    sigaddset(&awaited_, SIGCHLD);
    sigprocmask(SIG_BLOCK, &awaited_, nullptr);
  }

  void start() {
    exit_.reset();
    supervisor_ = fork();
    last_beat_ns_ = last_look_ns_ = now_ns();
    has_beaten_ = is_killed_ = false;
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
    execve(command_.arguments()[0], command_.arguments(), command_.environment());
    print_line(fmt::format("handcast: {}: {}", command_.arguments()[0], std::strerror(errno)));
    _exit(kExitRetry);
  }

  /// The number of a signal that arrived; 0 if none did within `span_ns`.
  int wait_for_signal(std::int64_t span_ns) const {
    const timespec span{span_ns / 1'000'000'000, span_ns % 1'000'000'000};
    return std::max(sigtimedwait(&awaited_, nullptr, &span), 0);
  }

  /// Waits for a signal, at most this long, and handles it. Then looks for beats.
  void look(std::int64_t span_ns) {
    handle(wait_for_signal(std::min(span_ns, kLook_ns)));
    const auto now = now_ns();
    if (now - std::exchange(last_look_ns_, now) > kStoodStill_ns) last_beat_ns_ = now;
    take_beats(now);
    if (supervisor_ <= 0 || is_killed_) return;
    if (stop_requests_ >= kImpatient)
      kill_supervisor("does not stop");
    else if (now - last_beat_ns_ > longest_silence_ns())
      kill_supervisor(fmt::format("has given no sign of life for {:.1f} s",
                                  ns_to_seconds(now - last_beat_ns_)));
  }

  void handle(int signal_number) {
    if (signal_number == SIGCHLD) return reap();
    if (signal_number == 0) return;
    sigaddset(&received_, signal_number);
    stop_requests_ =
        std::max(stop_requests_, ++received_count_[static_cast<std::size_t>(signal_number)]);
    if (supervisor_ > 0) kill(supervisor_, signal_number);
  }

  void take_beats(std::int64_t now) {
    Beat beat;
    while (recv(here_.get(), &beat, sizeof beat, MSG_DONTWAIT) == sizeof beat) {
      beat.rig.back() = '\0';
      rig_ = beat.rig.data();
      is_stopping_ = beat.stopping;
      last_beat_ns_ = now;
      has_beaten_ = true;
    }
  }

  std::int64_t longest_silence_ns() const {
    return has_beaten_ || stop_requests_ > 0 ? kLongestSilence_ns : kFirstBeat_ns;
  }

  void kill_supervisor(std::string_view why) {
    kill(supervisor_, SIGKILL);
    is_killed_ = true;
    log::warning("the supervisor (pid {}) {}; killed", supervisor_, why);
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

  /// True if the present supervisor follows one that died and the rig cannot be taken over now.
  bool cannot_take_over() const { return is_successor_ && exit_ && exit_->code == kExitRetry; }

  /// True if the rig was to be stopped when its supervisor died. Before the first beat the rig is
  /// not known, and only a successor can stop it; but not if supervisors hang so early.
  bool must_stop_the_rig() const {
    if (rig_.empty()) return stop_requests_ > 0 && is_killed_;
    return stop_requests_ > 0 || is_stopping_;
  }

  int stop_the_rig() {
    if (rig_.empty()) return see_off(kExitBadResult);
    const auto patience_s = stop_requests_ >= kImpatient ? 0 : kServices_s;
    const int ended = end_services(rig_, patience_s, now_ns());
    see_off(kExitDone);
    print_line(
        fmt::format("handcast: the supervisor ended before rig '{}' had stopped; its keeper "
                    "has ended the services that were left: {}",
                    rig_, ended));
    return kExitBadResult;
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
    const auto* services = "no service of its rig runs";
    if (rig_.empty())
      services = "if services of its rig run, `handcast down` stops them";
    else if (!find_services(rig_).empty())
      services =
          "its services continue to run: `handcast up` takes them over, `handcast down` stops them";
    print_line(fmt::format(
        "handcast: the supervisor died {} times within a minute ({}) and is not started again; {}",
        SupervisorDeaths::kDeathsInAMinute, exit_ ? exit_->describe() : "no process", services));
    return kExitRetry;
  }

  UniqueFd here_;  ///< the keeper's end of the socket pair for reports
  /// The supervisor's end. The keeper holds it open, so that no report is lost between two
  /// supervisors.
  UniqueFd there_;
  SupervisorCommand command_;
  SupervisorDeaths deaths_;
  sigset_t awaited_{};
  /// The stop signals received so far. A successor gets them, too, because the rig still has to be
  /// stopped.
  sigset_t received_{};
  std::array<int, NSIG> received_count_{};  ///< how often each came
  int stop_requests_ = 0;                   ///< how often the most frequent one came
  pid_t supervisor_ = -1;
  bool is_successor_ = false;  ///< the present supervisor follows one that died
  std::string rig_;            ///< name of the rig, from the beats; "" before the first one
  bool is_stopping_ = false;   ///< Beat::stopping of the last beat
  bool has_beaten_ = false;    ///< the present supervisor has
  bool is_killed_ = false;     ///< the present supervisor was killed by the keeper
  std::int64_t last_beat_ns_ = 0;
  std::int64_t last_look_ns_ = 0;
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
