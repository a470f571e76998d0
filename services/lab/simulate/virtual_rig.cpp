// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "ipc/base/clock.hpp"
#include "services/lab/simulate/recovery.hpp"
#include "services/lab/simulate/score.hpp"

namespace handcast::simulate {

Result<VirtualRig> open_virtual_rig(const config::Rig& rig, const calib::Calibration& calibration) {
  auto twin = twin::Twin::create(rig, calibration);
  if (!twin) return tl::make_unexpected(twin.error());
  const auto truth = [&world = **twin](renderer::Side side, std::int64_t time_ns) {
    return world.landmarks(side, time_ns);
  };
  auto pipeline =
      renderer::Pipeline::create(rig.cascade, rig.content, rig.hand, calibration, truth);
  if (!pipeline) return tl::make_unexpected(pipeline.error());
  auto detector = open_frame_detector(rig, calibration, **twin, config::Viewpoint::first);
  if (!detector) return tl::make_unexpected(detector.error());
  VirtualRig parts{std::move(*twin), std::move(*pipeline), std::move(*detector), std::nullopt,
                   nullptr};
  if (rig.pose.backend == "stereo") {
    auto second = SecondView::open(rig, calibration);
    if (!second) return tl::make_unexpected(second.error());
    parts.second = std::move(*second);
  }
  if (rig.pose.backend != "none") return parts;
  auto lifter = pose::Lifter::open(rig, calibration);
  if (!lifter) return tl::make_unexpected(lifter.error());
  parts.lifter = *lifter;
  return parts;
}

Result<void> run_ticks(const Options& options, Simulation& simulation,
                       const std::function<Result<void>(const Tick&)>& on_tick,
                       const OnProgress& on_progress) {
  const auto start_ns = seconds_to_ns(options.warm_up_s),
             end_ns = start_ns + seconds_to_ns(options.seconds);
  Result<void> done;
  while (simulation.now_ns() < end_ns && done) {
    const bool scored = simulation.now_ns() >= start_ns;
    simulation.step([&](const Tick& tick) {
      if (scored && done) done = on_tick(tick);
    });
    if (on_progress) on_progress(ns_to_seconds(simulation.now_ns()));
  }
  return done;
}

Result<std::vector<LightMoment>> moments_without_fault(config::Rig rig,
                                                       const calib::Calibration& calibration,
                                                       const Options& options,
                                                       const OnProgress& on_progress) {
  rig.twin = without_faults(rig.twin);
  auto parts = open_virtual_rig(rig, calibration);
  if (!parts) return tl::make_unexpected(parts.error());
  const auto feed =
      make_twin_feed(*parts->twin, std::move(parts->detector), {}, parts->lifter, parts->second);
  Simulation simulation(rig, calibration, *parts->pipeline, *feed, options.draw_every);
  std::vector<LightMoment> moments;
  const auto add = [&](const Tick& tick) -> Result<void> {
    if (tick.is_new) moments.push_back(moment_of(tick, 0, *parts->twin, calibration));
    return {};
  };
  const auto done = run_ticks(options, simulation, add, on_progress);
  if (!done) return tl::make_unexpected(done.error());
  return moments;
}

}  // namespace handcast::simulate
