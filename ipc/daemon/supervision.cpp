// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/supervision.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "ipc/base/clock.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/daemon/stop_signal.hpp"

namespace handcast::daemon {
namespace {

/// Added to the time that a process has to stop.
constexpr double kStopGrace_s = 1;
constexpr timespec kPreparedEvery{.tv_sec = 0, .tv_nsec = kPreparedEvery_ns};

/// SIGTERM and SIGINT wait while the object lives.
class StopsBlocked {
 public:
  StopsBlocked() {
    sigset_t stops;
    sigemptyset(&stops);
    for (const int number : {SIGTERM, SIGINT}) sigaddset(&stops, number);
    pthread_sigmask(SIG_BLOCK, &stops, &usual_);
  }
  ~StopsBlocked() { pthread_sigmask(SIG_SETMASK, &usual_, nullptr); }
  StopsBlocked(const StopsBlocked&) = delete;
  /// The mask without the block.
  const sigset_t& usual() const { return usual_; }

 private:
  sigset_t usual_;
};

}  // namespace

Supervision Supervision::from_environment(std::string name) {
  return {std::move(name), daemon::from_environment()};
}

Supervision::Supervision(std::string name, Handover handover)
    : name_(std::move(name)),
      rings_(std::move(handover.rings)),
      epoch_ns_(handover.epoch_ns.value_or(now_ns())),
      ready_(handover.ready_fd),
      turn_(handover.standby_fd) {}

bool Supervision::has_ring(std::string_view stream) const {
  return find_ring(rings_, stream).has_value();
}

// Each caller gets a descriptor of its own, so that one stream can be asked for twice.
Result<UniqueFd> Supervision::ring(std::string_view stream) const {
  if (rings_.empty())
    return fail(
        Errc::bad_config,
        fmt::format("{} was started by hand, without rings; `handcast up RIG.toml` starts it",
                    name_));
  const auto found = find_ring(rings_, stream);
  if (!found)
    return fail(Errc::bad_config,
                fmt::format("{} was given no ring '{}' in {}", name_, stream, kRingsVariable));
  UniqueFd fd(fcntl(*found, F_DUPFD_CLOEXEC, 3));
  if (!fd)
    return fail(Errc::unavailable,
                fmt::format("ring '{}', descriptor {}: {}", stream, *found, std::strerror(errno)));
  return fd;
}

// Signals are let in only while it sleeps, so that none is missed between the look at the flag and
// the sleep. The process ends without destructors: it has nothing to save, and its threads may run.
void Supervision::await_turn() {
  if (!is_standby()) return;
  {
    const StopsBlocked blocked;
    pollfd turn{.fd = turn_.get(), .events = POLLIN, .revents = 0};
    do {
      if (stop_requested()) std::_Exit(kExitDone);
      if (ready_) [[maybe_unused]]
        const auto told = ::write(ready_.get(), &kPreparedWord, 1);
    } while (ppoll(&turn, 1, &kPreparedEvery, &blocked.usual()) <= 0);
  }
  char word = 0;
  if (::read(turn_.get(), &word, 1) != 1) std::_Exit(kExitDone);
  turn_.reset();
  turn_ns_ = now_ns();
}

Deadline Supervision::predecessor_leaves_by(double stop_s) const {
  return turn_ns_ ? Deadline::at_ns(*turn_ns_ + seconds_to_ns(stop_s + kStopGrace_s))
                  : Deadline::now();
}

void Supervision::tell_ready() {
  log::info("ready");
  if (!ready_) return;
  if (::write(ready_.get(), &kReadyWord, 1) != 1)
    log::warning("the supervisor could not be told: {}", std::strerror(errno));
  ready_.reset();
}

bool Supervision::beat_is_due(std::int64_t now) const {
  return now - last_beat_ns_ >= kBeatEvery_ns;
}

}  // namespace handcast::daemon
