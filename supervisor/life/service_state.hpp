// SPDX-License-Identifier: Apache-2.0
// Everything that the supervisor remembers about one service, as a value. All times are of
// now_ns().
#pragma once
#include <cstdint>
#include <optional>
#include <variant>

#include "supervisor/base/exit.hpp"
#include "supervisor/life/restart_policy.hpp"
#include "supervisor/life/state.hpp"

namespace handcast::supervisor {

/// How a process came to be the worker.
enum class Origin { spawned, promoted, adopted };

/// What holds for a worker as long as its process lives.
struct Life {
  std::int64_t started_ns = 0;
  Origin origin = Origin::spawned;
  bool on_trial = false;  ///< its back end has never been ready: if it dies now, it has failed
};

/// The states of the worker, the process that does the service's work.
namespace worker {

/// No process, and none is due: never begun, stopped as asked, or its work is done.
struct Stopped {};

/// No process: a person must change something first.
struct Failed {};

/// No process: it is begun when its needs are met. The rig decides when that is.
struct Held {};

/// No process: it died and is started again in a while.
struct Waiting {
  std::int64_t due_ns = 0;
  bool degraded = false;  ///< it died too often
};

/// The process prepares itself.
struct Starting {
  Life life;
  std::int64_t late_ns = 0;  ///< from then on it is too late to be ready
};

/// The process said that it is ready and has not published anything yet.
struct AwaitingMessage {
  Life life;
  std::int64_t looked_ns = 0;  ///< when its stream was last looked at
  std::int64_t dry_ns = 0;     ///< how long it published nothing although its needs were ready
};

/// The process works.
struct Ready {
  Life life;
  std::int64_t ready_ns = 0;
  std::int64_t quiet_from_ns = 0;  ///< silence counts from here at the earliest
};

/// The process was killed because it was late or silent. Its end is not known yet.
struct Killed {
  Life life;
  std::optional<std::int64_t> ready_ns{};  ///< empty: it was never ready
};

/// The process was asked to stop.
struct Stopping {
  enum class Then { stay, start, start_on_trial };

  Life life;
  std::optional<std::int64_t> kill_ns{};  ///< empty: it was killed
  Then then = Then::stay;
};

/// The process has stopped as asked; its spare has not.
struct AwaitingSpare {};

}  // namespace worker

using Worker = std::variant<worker::Stopped, worker::Failed, worker::Held, worker::Waiting,
                            worker::Starting, worker::AwaitingMessage, worker::Ready,
                            worker::Killed, worker::Stopping, worker::AwaitingSpare>;

/// The states of the spare, a second process that has prepared everything and waits for its turn.
/// Its deaths are its own: they never count against the service.
namespace spare {

/// No process, and none is wanted.
struct None {};

/// No process: one is started in a while.
struct Due {
  std::int64_t start_ns = 0;
};

/// The process prepares itself.
struct Preparing {
  std::int64_t late_ns = 0;  ///< from then on it is too late to be prepared
};

/// The process can be promoted.
struct Prepared {
  std::int64_t prepared_ns = 0;
  std::int64_t sign_ns = 0;  ///< its last sign of life
};

/// The process was killed because it was late or silent. Its end is not known yet.
struct Killed {
  std::optional<std::int64_t> prepared_ns{};  ///< empty: it was never prepared
};

/// The process was asked to end.
struct Leaving {
  std::optional<std::int64_t> kill_ns{};   ///< empty: it was killed
  std::optional<std::int64_t> start_ns{};  ///< when the next one is due; empty: none is wanted
};

}  // namespace spare

using Spare = std::variant<spare::None, spare::Due, spare::Preparing, spare::Prepared,
                           spare::Killed, spare::Leaving>;

/// What outlives a process.
struct Past {
  DeathRecord deaths, spare_deaths;
  std::optional<Exit> last_exit{};               ///< of the worker
  std::optional<std::int64_t> first_start_ns{};  ///< empty: it was never begun
  int restarts = 0;
  bool was_ready = false;  ///< in this or an earlier life
};

/// One service. next() says what becomes of it (next.hpp).
struct ServiceState {
  Worker worker;
  Spare spare;
  Past past;
};

/// The worker's life; null if it has no process.
const Life* life_of(const Worker& worker);
/// Whether the spare has a process.
bool is_running(const Spare& spare);
/// The state as it is shown to a person.
State shown(const Worker& worker);

}  // namespace handcast::supervisor
