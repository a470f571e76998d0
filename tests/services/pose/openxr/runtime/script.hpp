// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <set>
#include <string>

namespace handcast::test_runtime {

/// The environment variable with the path of the script. Without it, the defaults count.
inline constexpr const char* kScriptVariable = "HANDCAST_TEST_RUNTIME";

/// How a runtime makes joints for a time from the samples of its tracker.
enum class Times {
  interpolates,  ///< between samples; after the newest one, that one
  holds,         ///< the newest sample, whatever the time
  predicts,      ///< after the newest one, the line through the last four
  knows,         ///< the truth at any time, as a runtime with much faster sensors
  overshoots,    ///< after the newest one, twice as far as it should
};

/// What the runtime does. A line of the script is the name of a member, with a value if it is no
/// flag: "lacks XR_MND_headless", "times holds", "rate_hz 90". It may change at any time.
struct Script {
  std::set<std::string> lacks;                 ///< extensions
  bool refuses = false;                        ///< gives no instance: its service does not run
  bool crashes = false;                        ///< when an instance is created
  bool hangs_at_start = false, hangs = false;  ///< the call of an instance, or for joints: no end
  bool no_system = false, no_hands = false, no_stage = false;
  bool never_ready = false;
  bool stops = false;  ///< stops the session for as long as this stands here
  bool loses_session = false, loses_instance = false, ends = false;
  bool moves_space = false;                       ///< reports once that the origin moves
  std::set<std::string> inactive;                 ///< left, right
  bool unknown_joint = false, no_number = false;  ///< of the left hand
  bool refuses_times = false;
  Times times = Times::interpolates;
  double rate_hz = 500, age_ms = 2, noise_mm = 0.05;
  std::string motion;          ///< a file (motion.hpp); empty: a left hand that sways
  std::int64_t epoch_ns = -1;  ///< time zero of the motion; -1: the first time that is asked for
};

/// The script as it is now.
const Script& script();

}  // namespace handcast::test_runtime
