// SPDX-License-Identifier: Apache-2.0
// The events of a service and the actions that follow from them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "supervisor/base/exit.hpp"
#include "supervisor/life/process_activity.hpp"
#include "supervisor/life/service_state.hpp"

namespace handcast::supervisor {

/// What happens to a service: the argument of next().
namespace event {

// Requests of the rig, which Service documents by the functions of the same names.

/// Service::hold().
struct Hold {};
/// Service::start().
struct Start {};
/// Service::stop().
struct Stop {};
/// Service::hurry().
struct Hurry {};
/// Service::prepare().
struct Prepare {
  Replacement how{};           ///< the properties of the replacement
  bool may_use_spare = false;  ///< a standby has the wanted settings
};
/// Service::hand_over().
struct HandOver {};
/// Service::abandon().
struct Abandon {};
/// Service::restart() and Service::use_backend().
struct Restart {
  bool on_trial = false;  ///< do not restart it if it dies before it is ready
};
/// Service::update(): the rules may have changed.
struct SettingsChanged {};
/// Service::inherit(): the state saved by an earlier supervisor.
struct Inherited {
  State state = State::starting;  ///< SavedService::state
  int restarts = 0;               ///< SavedService::restarts
};
/// Service::adopt(): a ready process of an earlier supervisor.
struct Adopted {
  std::int64_t started_ns = 0;  ///< when the process was started
};
/// Service::forgive(): the supervisor, or the machine, stood still.
struct StoodStill {
  std::int64_t span_ns = 0;  ///< for how long
};

// Events of the processes.

/// The worker reported that it is ready.
struct SaidReady {
  bool published = false;  ///< it has published its first message already
};
/// The worker ended.
struct Ended {
  Exit exit;  ///< how it ended
};
/// The worker could not be started.
struct NotStarted {
  Exit exit;  ///< the exit code of the error
};
/// The spare reported that it is prepared; it repeats this as its heartbeat.
struct SpareSpoke {};
/// The spare ended.
struct SpareEnded {
  Exit exit;  ///< how it ended
};
/// The spare could not be started.
struct SpareNotStarted {
  std::string why;  ///< the sentence of the error
};
/// Time has passed; sent a few dozen times per second.
struct Tick {
  bool published = false;       ///< the worker has published a message since its start
  bool needs_are_ready = true;  ///< the services that it needs are ready
  /// The time of the worker's last frame or heartbeat; empty if there was none.
  std::optional<std::int64_t> last_sign_ns{};
  Activity activity = Activity::unknown;  ///< what the worker did since the last tick
};

}  // namespace event

/// Any event.
using Event = std::variant<event::Hold, event::Start, event::Stop, event::Hurry, event::Prepare,
                           event::HandOver, event::Abandon, event::Restart, event::SettingsChanged,
                           event::Inherited, event::Adopted, event::StoodStill, event::SaidReady,
                           event::Ended, event::NotStarted, event::SpareSpoke, event::SpareEnded,
                           event::SpareNotStarted, event::Tick>;

/// A change of a service that the rig must know. After `failed`, it is not restarted.
enum class Notice { ready, stopped, failed };

/// What to do after an event: the results of next().
namespace action {

/// Start a worker.
struct Spawn {};
/// Make the spare the worker.
struct Promote {};
/// Send SIGTERM to the worker and make the spare the worker. The old worker becomes the spare.
struct HandOver {};
/// Ask the worker to stop.
struct AskToStop {
  bool for_good = false;  ///< no other process takes over: send SIGINT; otherwise SIGTERM
};
/// Send SIGKILL to the worker.
struct Kill {};
/// Start a spare.
struct SpawnSpare {};
/// Send SIGTERM to the spare.
struct AskSpareToStop {};
/// Send SIGKILL to the spare.
struct KillSpare {};
/// Report that the replacement cannot take over.
struct ReplacementFailed {
  std::string why;         ///< "exit 100", or "was not prepared within 10 s"
  bool by_itself = false;  ///< it ended by itself: its last words say more
};
/// Read the rest of the output of the worker that ended, so that it is printed before the message
/// about its end.
struct ReadLastWords {};
/// Log a warning.
struct Warn {
  std::string sentence;  ///< the message
};
/// Notify the rig. Always the last action, because the rig may change the service in return.
struct Tell {
  Notice notice = Notice::ready;  ///< the change
};

}  // namespace action

/// Any action.
using Action =
    std::variant<action::Spawn, action::Promote, action::HandOver, action::AskToStop, action::Kill,
                 action::SpawnSpare, action::AskSpareToStop, action::KillSpare,
                 action::ReplacementFailed, action::ReadLastWords, action::Warn, action::Tell>;

}  // namespace handcast::supervisor
