// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "calib/sub_frames.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/lab/simulate/virtual_rig.hpp"

namespace handcast::simulate {

/// Runs the rig on its twin in virtual time and returns the metrics of `simulate --json`: those of
/// twin::Metrics, and "rig", "motion", "mesh", "speed", "seed", "seconds", "software_ms",
/// "motion_to_photon_ms" (from the middle of the exposure of a frame's image to the middle of its
/// light, mean over the drawn frames; null without any), "hand_speed_m_s" (HandSpeed), "fault"
/// (Recovery) and "detector" (DetectorTally, with "backend" and "age_ms", and, if a fallback took
/// the place of the rig's detector, "why"). A rig with a timed fault runs twice, the second time
/// without the fault.
///
/// Ignores rig_file and settings of the options, which are in `rig` already. Thread-safe: calls
/// share no state, and the figures do not depend on other calls. Errors: those of the twin, the
/// pipeline and the detector (bad_config), and of files that cannot be written.
Result<nlohmann::json> score(const config::Rig& rig, const calib::Calibration& calibration,
                             const Options& options, const OnProgress& on_progress = {});

/// Why metrics of score() say nothing: no hand was there to be scored. Empty if they do.
std::string why_nothing_was_scored(const nlohmann::json& metrics, const Options& options);

/// The virtual time that score() will simulate: the last value of `on_progress`.
double simulated_s(const config::Rig& rig, const Options& options);

}  // namespace handcast::simulate
