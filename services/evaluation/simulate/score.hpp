// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/evaluation/simulate/virtual_rig.hpp"

namespace handcast::simulate {

/// Runs the rig on its twin in virtual time and gives the metrics of `simulate --json`: those of
/// twin::Metrics, and "rig", "motion", "speed", "seed", "seconds", "software_ms",
/// "motion_to_photon_ms" (from the middle of the exposure that a frame shows to the middle of its
/// light, mean over the drawn frames; null where none was drawn), "hand_speed_m_s" (HandSpeed),
/// "fault" (recovery.hpp) and "detector" (DetectorTally, with its back end and "age_ms" as set). A
/// rig whose twin times a fault runs twice, the second time without it. Of the options it reads the
/// times, what to draw and the folders of pictures, trace and recording; the rig's own are done
/// with. Nothing is shared between two calls: they may run side by side, and give the same figures
/// as one after the other.
Result<nlohmann::json> score(const config::Rig& rig, const calib::Calibration& calibration,
                             const Options& options, const OnProgress& on_progress = {});

/// What `on_progress` comes to.
double simulated_s(const config::Rig& rig, const Options& options);

}  // namespace handcast::simulate
