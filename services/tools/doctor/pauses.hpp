// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"
#include "services/tools/doctor/tracker.hpp"

namespace handcast::doctor {

/// The counts of interrupts of one core in the text of /proc/interrupts, by number or short name.
struct Interrupts {
  struct Line {
    std::string name;  ///< of the devices, or what it is: "eno1", "Local timer interrupts"
    std::uint64_t count = 0;
  };
  std::map<std::string, Line, std::less<>> lines;  ///< by "24" or "LOC"
};
Interrupts interrupts_in(std::string_view text, int core);

/// What kept a loop like the projector's from its work.
struct Pauses {
  int core = 0;            ///< where it ran
  int priority = 0;        ///< real-time priority that it had; 0: none
  bool is_denied = false;  ///< the rig's priority is denied to this program
  double period_us = 0;    ///< of a frame
  std::size_t frames = 0;  ///< number of frames
  double longest_us = 0;   ///< the longest pause
  double p99_us = 0;       ///< 99 % of the frames had shorter ones
  Interrupts interrupts;   ///< on this core meanwhile; none without a count
};

/// Runs such a loop for about a second on the projector's core and with its priority: it sleeps
/// until each frame begins and looks at the clock for 80 % of its period. A late awakening is a
/// pause, too.
Pauses measure_pauses(const config::Rig& rig);

/// Judges the pauses of a loop.
Finding judge_pauses(const Pauses& pauses);

/// Measures and judges. No findings if the rig is up, because the loop would disturb it.
std::vector<Finding> examine_pauses(const config::Rig& rig, Asking asking);

}  // namespace handcast::doctor
