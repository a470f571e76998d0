// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "supervisor/base/exit.hpp"

namespace handcast::supervisor {

/// The end of one process of a service. Times are CLOCK_MONOTONIC.
struct Death {
  std::int64_t died_ns = 0;              ///< when the process ended
  std::optional<std::int64_t> ready_ns;  ///< when it became ready; empty: it was never ready
  Exit exit;                             ///< how it ended
};

/// The deaths of a service so far.
struct DeathRecord {
  int streak = 0;                       ///< deaths since it was last healthy
  std::vector<std::int64_t> recent_ns;  ///< deaths within the storm window, oldest first
};

/// The reaction to a death.
struct Decision {
  /// What to do with the service.
  enum class Action {
    restart,  ///< restart it after wait_ns
    degrade,  ///< it dies too often: restart it after wait_ns, and report it as degraded
    fail,     ///< exit 100: do not restart it, a person must change something
    retire    ///< exit 0 without a request to stop: its work is done
  };
  Action action = Action::restart;  ///< what to do
  std::int64_t wait_ns = 0;         ///< time before the restart
  DeathRecord record;               ///< the argument of decide() for the next death
};

inline constexpr std::int64_t kFirstWait_ns = 50'000'000;       ///< wait before the second restart
inline constexpr std::int64_t kLongestWait_ns = 5'000'000'000;  ///< limit of the doubled waits
inline constexpr double kMostJitter = 0.25;                     ///< as a fraction of the wait
/// A service that was ready for this long is healthy: its streak of deaths begins anew.
inline constexpr std::int64_t kHealthyAfter_ns = 30'000'000'000;
/// A service that dies kStormDeaths times within kStormWindow_ns is degraded.
/// @{
inline constexpr std::int64_t kStormWindow_ns = 60'000'000'000;
inline constexpr std::size_t kStormDeaths = 10;
/// @}

/// Decides what to do after a death. The first restart is immediate, the next comes after 50 ms,
/// 100 ms, ... up to 5 s. After 30 s of health, the waits begin anew. Ten deaths within a minute
/// degrade the service, however they are spaced; health does not clear that count, only time does.
/// `jitter` (0..1) makes a wait up to a quarter longer, so that services that died together are not
/// restarted together.
Decision decide(DeathRecord record, const Death& death, double jitter = 0);

/// A jitter for decide() from the last digits of the time, which differ even between services that
/// die together.
double jitter_at(std::int64_t now_ns);

}  // namespace handcast::supervisor
