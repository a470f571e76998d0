// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "supervisor/look/figures/figures.hpp"
#include "supervisor/record/recorder.hpp"
#include "supervisor/rig/service_table.hpp"

namespace handcast::supervisor {

/// A rig at one moment. The references are to members of a LiveRig.
struct RigView {
  const std::string& name;      ///< LiveRig::name
  const Services& services;     ///< LiveRig::services
  const Recorder& recorder;     ///< LiveRig::recorder
  std::int64_t started_ns = 0;  ///< LiveRig::started_ns
  std::int64_t now_ns = 0;      ///< the moment, CLOCK_MONOTONIC
  bool keeper_died = false;     ///< KeeperLink::keeper_died()
};

/// The figures of a rig, which answer `handcast status`.
Figures figures_of(const RigView& rig);
/// One line of figures: "up 12 s  camera 240 Hz  pose 110 Hz  ...  restarts 0".
std::string progress_line(const RigView& rig);
/// The figures of a whole run (live.json).
nlohmann::json live_report(const RigView& rig);

}  // namespace handcast::supervisor
