// SPDX-License-Identifier: Apache-2.0
// What happens to a service, and what is to be done about it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "supervisor/base/exit.hpp"
#include "supervisor/life/state.hpp"

namespace handcast::supervisor {

namespace event {

// Requests of the rig.

struct Hold {};   ///< it will be begun when its needs are met
struct Start {};  ///< it is begun
struct Stop {};
struct Hurry {};  ///< what was asked to stop is killed now
/// Stopped and started again.
struct Restart {
  bool on_trial = false;  ///< with a back end that may not work
};
struct SettingsChanged {};
/// What an earlier supervisor remembered of it.
struct Inherited {
  State state = State::starting;
  int restarts = 0;
};
/// A ready process of an earlier supervisor goes on.
struct Adopted {
  std::int64_t started_ns = 0;
};
/// The supervisor, or the machine, stood still for this long: nobody is late for it.
struct StoodStill {
  std::int64_t span_ns = 0;
};

// What the worker and the spare do.

struct SaidReady {
  bool published = false;  ///< its first message is there already
};
struct Ended {
  Exit exit;
};
struct NotStarted {
  Exit exit;  ///< as if a process had ended so
};
struct SpareSpoke {};
struct SpareEnded {
  Exit exit;
};
struct SpareNotStarted {
  std::string why;
};

/// Time passes: a few dozen times a second.
struct Tick {
  bool published = false;                  ///< since the worker was started
  bool needs_are_ready = true;             ///< the services that it needs
  std::optional<std::int64_t> heard_ns{};  ///< its last sign of life; empty: there was none
};

}  // namespace event

using Event =
    std::variant<event::Hold, event::Start, event::Stop, event::Hurry, event::Restart,
                 event::SettingsChanged, event::Inherited, event::Adopted, event::StoodStill,
                 event::SaidReady, event::Ended, event::NotStarted, event::SpareSpoke,
                 event::SpareEnded, event::SpareNotStarted, event::Tick>;

/// What a service tells its rig.
enum class Notice { ready, stopped, failed };

namespace action {

struct Spawn {};      ///< a worker
struct Promote {};    ///< the spare becomes the worker
struct AskToStop {};  ///< the worker
struct Kill {};       ///< the worker
struct SpawnSpare {};
struct AskSpareToStop {};
struct KillSpare {};
/// Reads what the worker that ended has written: it comes before what is said of its end.
struct ReadLastWords {};
struct Warn {
  std::string sentence;
};
/// Always the last action: the rig may do anything with the service.
struct Tell {
  Notice notice = Notice::ready;
};

}  // namespace action

using Action = std::variant<action::Spawn, action::Promote, action::AskToStop, action::Kill,
                            action::SpawnSpare, action::AskSpareToStop, action::KillSpare,
                            action::ReadLastWords, action::Warn, action::Tell>;

}  // namespace handcast::supervisor
