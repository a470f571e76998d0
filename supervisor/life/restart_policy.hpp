// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "supervisor/base/exit.hpp"

namespace handcast::supervisor {

/// How one life of a service ended.
struct Death {
  std::int64_t died_ns = 0;
  std::optional<std::int64_t> ready_ns;  ///< empty: it was never ready
  Exit exit;
};

/// The deaths of a service so far.
struct DeathRecord {
  int streak = 0;                       ///< deaths since it was last healthy
  std::vector<std::int64_t> recent_ns;  ///< deaths within the storm window, oldest first
};

/// What follows from a death.
struct Decision {
  enum class Action {
    restart,  ///< after wait_ns
    degrade,  ///< it dies too often: after wait_ns, while the rest of the rig goes on
    fail,     ///< exit 100: a person must change something
    retire    ///< exit 0 that nobody asked for: its work is done
  };
  Action action = Action::restart;
  std::int64_t wait_ns = 0;
  DeathRecord record;  ///< to hand in at the next death
};

inline constexpr std::int64_t kFirstWait_ns = 50'000'000;
inline constexpr std::int64_t kLongestWait_ns = 5'000'000'000;
inline constexpr double kMostJitter = 0.25;  ///< of a wait
inline constexpr std::int64_t kHealthyAfter_ns = 30'000'000'000;
inline constexpr std::int64_t kStormWindow_ns = 60'000'000'000;
inline constexpr std::size_t kStormDeaths = 10;

/// The first restart comes at once, the next after 50 ms, 100 ms, ... up to 5 s. After 30 s of
/// health the next restart is a first one again. Ten deaths within a minute are a storm, however
/// they are spaced: only time clears that count, not health. `jitter` (0..1) makes a wait up to a
/// quarter longer, so that services that died together do not come back together.
Decision decide(DeathRecord record, const Death& death, double jitter = 0);

/// A jitter for decide() out of the last digits of the time, which differ even between services
/// that die together.
double jitter_at(std::int64_t now_ns);

}  // namespace handcast::supervisor
