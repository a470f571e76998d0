// SPDX-License-Identifier: Apache-2.0
// The state of one service, as a value. All times are CLOCK_MONOTONIC.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "supervisor/base/exit.hpp"
#include "supervisor/life/restart_policy.hpp"
#include "supervisor/life/state.hpp"

namespace handcast::supervisor {

/// How a process became the worker: it was started, it was the standby, or an earlier supervisor
/// had started it.
enum class Origin { spawned, promoted, adopted };

/// The constant properties of a worker's process.
struct Life {
  std::int64_t started_ns = 0;      ///< when it became the worker
  Origin origin = Origin::spawned;  ///< how it became the worker
  bool on_trial = false;  ///< its back end is new: if it dies before it is ready, it has failed
};

/// The states of the worker, the process that does the service's work.
namespace worker {

/// No process: never started, stopped on request, or its work is done.
struct Stopped {};
/// No process, and no restart until a person changes something.
struct Failed {};
/// No process: the rig will start it when its needs are met.
struct Held {};
/// No process: it died and will be restarted.
struct Waiting {
  std::int64_t due_ns = 0;  ///< the time of the restart
  bool degraded = false;    ///< it died too often
};
/// The process was started and has not reported ready.
struct Starting {
  Life life;                 ///< its process
  std::int64_t late_ns = 0;  ///< it is killed if it is not ready by then
};
/// The process reported ready and has not published a message yet.
struct AwaitingMessage {
  Life life;                   ///< its process
  std::int64_t looked_ns = 0;  ///< when its stream was last checked
  std::int64_t dry_ns = 0;     ///< how long it published nothing while its needs were ready
};
/// The process works.
struct Ready {
  Life life;                       ///< its process
  std::int64_t ready_ns = 0;       ///< when it became ready
  std::int64_t quiet_from_ns = 0;  ///< silence before this time does not count
  /// Since when each tick found it stopped or asleep; empty: the last one did not, or did not look.
  std::optional<std::int64_t> inert_from_ns{};
  std::int64_t held_up_ns = 0;  ///< how much of the silence it could not work
};
/// The process was killed because it was late or silent, and has not ended yet.
struct Killed {
  Life life;                               ///< its process
  std::optional<std::int64_t> ready_ns{};  ///< when it became ready; empty: it never was
};
/// The process was asked to stop.
struct Stopping {
  /// What follows: nothing, another start, or the promotion of the replacement.
  enum class Then { stay, start, start_on_trial, hand_over };
  Life life;                              ///< its process
  std::optional<std::int64_t> kill_ns{};  ///< when it is killed; empty: it has been
  Then then = Then::stay;                 ///< what follows
};
/// The process has stopped on request; its standby has not ended yet.
struct AwaitingStandby {};

}  // namespace worker

/// The state of the worker.
using Worker = std::variant<worker::Stopped, worker::Failed, worker::Held, worker::Waiting,
                            worker::Starting, worker::AwaitingMessage, worker::Ready,
                            worker::Killed, worker::Stopping, worker::AwaitingStandby>;

/// The states of the standby, a second process that has prepared itself and waits for its turn: a
/// standby, or a replacement. A worker that was replaced while it worked becomes the standby until
/// it has ended. Deaths of standbys do not count as deaths of the service.
namespace standby {

/// No process, and none is wanted.
struct None {};
/// No process: one will be started.
struct Due {
  std::int64_t start_ns = 0;  ///< the time of the start
};
/// The process was started and is not prepared yet.
struct Preparing {
  std::int64_t late_ns = 0;  ///< it is killed if it is not prepared by then
};
/// The process can be promoted.
struct Prepared {
  std::int64_t prepared_ns = 0;  ///< when it became prepared
  std::int64_t sign_ns = 0;      ///< its last heartbeat
};
/// The process was killed because it was late or silent, and has not ended yet.
struct Killed {
  std::optional<std::int64_t> prepared_ns{};  ///< when it became prepared; empty: it never was
  std::string why{};                          ///< "was not prepared within 10 s"
};
/// The process was asked to stop.
struct Leaving {
  std::optional<std::int64_t> kill_ns{};   ///< when it is killed; empty: it has been
  std::optional<std::int64_t> start_ns{};  ///< when to start the next one; empty: none is wanted
};

}  // namespace standby

/// The state of the standby.
using Standby = std::variant<standby::None, standby::Due, standby::Preparing, standby::Prepared,
                             standby::Killed, standby::Leaving>;

/// The history of a service, over all its processes.
struct Past {
  /// The deaths of its workers and of its standbys.
  /// @{
  DeathRecord deaths, standby_deaths;
  /// @}
  std::optional<Exit> last_exit{};               ///< how the last worker ended
  std::optional<std::int64_t> first_start_ns{};  ///< when it was first started; empty: never
  int restarts = 0;                              ///< number of restarts after a death
  bool was_ready = false;                        ///< a worker has been ready
  /// The last worker ended with exit 111 before it was ready: something that it needs, as a device,
  /// is missing. That was said, and is not said again before it can start.
  bool waits = false;
};

/// A standby that takes over from a worker that works: for new settings, or because a person asked
/// for a restart.
struct Replacement {
  bool on_trial = false;  ///< see Life
  /// It gets its turn only when the worker has ended, because both open the same device.
  bool alone = false;
};

/// The state of one service. next() computes the next one (next.hpp).
struct ServiceState {
  Worker worker;    ///< the process that does the work
  Standby standby;  ///< the process that can replace it
  std::optional<Replacement>
      replacement{};  ///< set while the standby is a replacement, or is to be
  Past past;          ///< their history
};

/// The worker's process; null if it has none.
const Life* life_of(const Worker& worker);
/// True if the standby has a process.
bool is_running(const Standby& standby);
/// The state as `handcast status` shows it.
State shown(const Worker& worker);

}  // namespace handcast::supervisor
