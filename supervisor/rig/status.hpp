// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "supervisor/record/recorder.hpp"
#include "supervisor/rig/service_table.hpp"

namespace handcast::supervisor {

/// A rig at one moment.
struct RigView {
  const std::string& name;
  const Services& services;
  const Recorder& recorder;
  std::int64_t started_ns = 0;
  std::int64_t now_ns = 0;
};

/// The status of a rig, as `handcast status --json` prints it.
nlohmann::json status_of(const RigView& rig);
/// A status as text.
std::string print_status(const nlohmann::json& status);
/// One line of figures: "up 12 s  camera 240 Hz  pose 110 Hz  ...  restarts 0".
std::string progress_line(const RigView& rig);
/// The figures of a whole run (live.json).
nlohmann::json live_report(const RigView& rig);

}  // namespace handcast::supervisor
