// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ipc/daemon/contract.hpp"
#include "supervisor/base/exit.hpp"
#include "supervisor/life/process_activity.hpp"
#include "supervisor/life/service_state.hpp"

namespace handcast::supervisor {

// The events of a service and the actions that follow from them.

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
  Replacement how{};             ///< the properties of the replacement
  bool may_use_standby = false;  ///< a standby has the wanted settings
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
/// The standby reported that it is prepared; it repeats this as its heartbeat.
struct StandbySpoke {};
/// The standby ended.
struct StandbyEnded {
  Exit exit;  ///< how it ended
};
/// The standby could not be started.
struct StandbyNotStarted {
  std::string why;  ///< the sentence of the error
};
/// Time has passed; sent a few dozen times per second.
struct Tick {
  bool published = false;       ///< the worker has published a message since its start
  bool needs_are_ready = true;  ///< the services that it needs are ready
  /// The time of the worker's last frame or heartbeat; empty if there was none.
  std::optional<std::int64_t> last_sign_ns{};
  Activity activity = Activity::unknown;  ///< what the worker did since the last tick
  std::int64_t held_up_ns = 0;            ///< how long it could not work since then
};

}  // namespace event

/// Any event.
using Event = std::variant<event::Hold, event::Start, event::Stop, event::Hurry, event::Prepare,
                           event::HandOver, event::Abandon, event::Restart, event::SettingsChanged,
                           event::Inherited, event::Adopted, event::StoodStill, event::SaidReady,
                           event::Ended, event::NotStarted, event::StandbySpoke,
                           event::StandbyEnded, event::StandbyNotStarted, event::Tick>;

/// A change of a service that the rig must know. After `failed`, it is not restarted.
enum class Notice { ready, stopped, failed };

/// What to do after an event: the results of next().
namespace action {

/// Start a worker.
struct Spawn {};
/// Make the standby the worker.
struct Promote {};
/// Send SIGTERM to the worker and make the standby the worker. The old worker becomes the standby.
struct HandOver {};
/// Ask the worker to stop.
struct AskToStop {
  bool for_good = false;  ///< no other process takes over: send SIGINT; otherwise SIGTERM
};
/// Send SIGKILL to the worker.
struct Kill {};
/// Start a standby.
struct SpawnStandby {};
/// Send SIGTERM to the standby.
struct AskStandbyToStop {};
/// Send SIGKILL to the standby.
struct KillStandby {};
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
                 action::SpawnStandby, action::AskStandbyToStop, action::KillStandby,
                 action::ReplacementFailed, action::ReadLastWords, action::Warn, action::Tell>;

/// The settings of the rig file that next() needs about a service.
struct Rules {
  std::string_view name;       ///< name of the service, for messages: "pose"
  std::int64_t ready_ns = 0;   ///< time limit for a worker to be ready and a standby to be prepared
  std::int64_t stop_ns = 0;    ///< time limit for a process to stop; then it is killed
  std::int64_t silent_ns = 0;  ///< longest time without a heartbeat: see the watchdog below
  bool publishes = false;      ///< it has a stream: it is not ready before its first message
  bool wants_standby = false;  ///< a standby is kept
};

// The watchdog: a worker that has been silent for silent_ns is killed even if it works, because it
// may be in an endless loop. A quarter of this time is enough if all its threads are stopped, half
// of it if all of them sleep without ever asking for a processor. The time in which it waits for a
// processor on a loaded machine, or for a cold disk, does not count, until ready_ns have passed.

/// The parts of silent_ns, and the least of them: three times the longest pause between heartbeats.
/// @{
inline constexpr double kStoppedPart = 0.25, kAsleepPart = 0.5;
inline constexpr std::int64_t kLeastSilence_ns = 3 * daemon::kBeatEvery_ns;
/// @}
/// It must have been stopped or asleep for this part of the permitted silence.
inline constexpr double kInertPart = 0.3;

/// True if the worker has been silent for so long that the next Tick needs its activity.
/// `last_sign_ns`: see event::Tick.
bool is_suspicious(const ServiceState& state, std::optional<std::int64_t> last_sign_ns,
                   std::int64_t now_ns, const Rules& rules);

/// The result of next().
struct Step {
  ServiceState state;           ///< the new state
  std::vector<Action> actions;  ///< to be carried out in this order
};

/// The state of a service after an event, and the actions that follow. A pure function that makes
/// all decisions about a service. Transition::died() in next.cpp handles deaths; decide() in
/// restart_policy.hpp determines the waiting time before a restart.
Step next(ServiceState state, const Event& event, std::int64_t now_ns, const Rules& rules);

}  // namespace handcast::supervisor
