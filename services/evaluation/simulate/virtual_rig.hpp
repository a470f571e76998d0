// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "services/evaluation/simulate/light_moment.hpp"
#include "services/evaluation/simulate/options.hpp"
#include "services/evaluation/simulate/sensor_feed.hpp"

namespace handcast::simulate {

/// What a run in virtual time is made of.
struct VirtualRig {
  std::unique_ptr<twin::Twin> twin;
  std::unique_ptr<renderer::Pipeline> pipeline;
  std::unique_ptr<FrameDetector> detector;  ///< to be moved into the feed
};
/// Errors: as the parts say them.
Result<VirtualRig> open_virtual_rig(const config::Rig& rig, const calib::Calibration& calibration);

/// Told after every projector frame how much virtual time is done, the warm-up included.
using OnProgress = std::function<void(double done_s)>;

/// Runs the warm-up and the seconds of the options; the ticks of the latter go to `on_tick`, whose
/// first error ends the run.
Result<void> run_ticks(const Options& options, Simulation& simulation,
                       const std::function<Result<void>(const Tick&)>& on_tick,
                       const OnProgress& on_progress = {});

/// The light of the same run, were there none of the faults that the rig's twin times. Takes as
/// long as the run itself.
Result<std::vector<LightMoment>> moments_without_fault(config::Rig rig,
                                                       const calib::Calibration& calibration,
                                                       const Options& options,
                                                       const OnProgress& on_progress = {});

}  // namespace handcast::simulate
