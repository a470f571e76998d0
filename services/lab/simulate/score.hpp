// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "calib/sub_frames.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/lab/simulate/light_moment.hpp"
#include "services/lab/simulate/options.hpp"
#include "services/lab/simulate/second_view.hpp"
#include "services/lab/simulate/sensor_feed.hpp"

namespace handcast::simulate {

/// The parts of a run in virtual time.
struct VirtualRig {
  std::unique_ptr<twin::Twin> twin;              ///< must outlive the other two
  std::unique_ptr<renderer::Pipeline> pipeline;  ///< the cascade
  std::unique_ptr<FrameDetector> detector;       ///< must be moved into the feed
  std::optional<pose::Lifter> lifter;            ///< the same; empty if the rig has a tracker
  std::shared_ptr<SecondView> second;            ///< the same; null without pose.backend "stereo"
  SentMessages sent;                             ///< of Options::poses_file and landmarks_file
};

/// Refuses the back ends of sensors whose light cannot be scored: all that do not see the twin's
/// hand, unless the options have their results. Errors: bad_config, with all of them and what to
/// add to the command.
Result<void> check_can_be_scored(const config::Rig& rig, const Options& options = {});

/// Opens the parts for a rig and one of its projectors. Errors: those of check_can_be_scored,
/// Twin::create, Pipeline::create, open_frame_detector, read_poses and read_landmarks.
Result<VirtualRig> open_virtual_rig(const config::Rig& rig, const calib::Calibration& calibration,
                                    const Options& options = {},
                                    config::Viewpoint projector = config::Viewpoint::first);

/// Called after each projector frame with the virtual time done so far, warm-up included.
using OnProgress = std::function<void(double done_s)>;

/// Runs the warm-up and the scored time of the options, and passes the ticks of the latter to
/// `on_tick`. Stops at the first error of `on_tick` and returns it.
Result<void> run_ticks(const Options& options, Simulation& simulation,
                       const std::function<Result<void>(const Tick&)>& on_tick,
                       const OnProgress& on_progress = {});

/// The light of the same run without the timed faults. Takes as long as the run itself. Errors: as
/// open_virtual_rig.
Result<std::vector<LightMoment>> moments_without_fault(config::Rig rig,
                                                       const calib::Calibration& calibration,
                                                       const Options& options,
                                                       const OnProgress& on_progress = {});

/// Runs the rig on its twin in virtual time and returns the metrics of `simulate --json`: those of
/// twin::Metrics, and "rig", "motion", "mesh", "speed", "seed", "seconds", "software_ms",
/// "motion_to_photon_ms" (from the middle of the exposure of a frame's image to the middle of its
/// light, mean over the drawn frames; null without any), "hand_speed_m_s" (HandSpeed), "poses"
/// (the file that they are from, or null), "shared" (the light of both projectors:
/// twin::SharedJudge; null if there is one), "fault" (Recovery) and "detector" (DetectorTally, with
/// "backend" and "age_ms", and, if a fallback took the place of the rig's detector, "why"). A rig
/// with a timed fault runs twice, the second time without the fault, but not if the options have
/// results of other methods, which say nothing of that.
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
