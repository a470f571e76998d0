// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/lab/simulate/score.hpp"
#include "services/lab/simulate/simulation.hpp"
#include "services/lab/twin/shared_light.hpp"

namespace handcast::simulate {

/// The second projector of a rig in virtual time, with a cascade of its own, and the judge of both
/// lights. One thread.
class SecondLight {
 public:
  /// Errors: those of open_virtual_rig(). `twin` must outlive the object.
  static Result<std::unique_ptr<SecondLight>> open(const config::Rig& rig,
                                                   const calib::Calibration& calibration,
                                                   const Options& options, const twin::Twin& twin);

  /// Runs its frames until `now_ns`, and judges its newest light and that of the first projector.
  void judge(const msg::Projection& first, std::int64_t now_ns);

  /// The metrics of both lights, and the picture of those judged last: twin::SharedJudge.
  /// @{
  nlohmann::json to_json() const;
  renderer::View<const std::uint32_t> picture() { return judge_.picture(); }
  /// @}

 private:
  SecondLight(const config::Rig& rig, const calib::Calibration& calibration, const Options& options,
              const twin::Twin& twin, VirtualRig parts);

  VirtualRig parts_;
  std::unique_ptr<SensorFeed> feed_;
  Simulation simulation_;
  twin::SharedJudge judge_;
  const msg::Projection* newest_ = nullptr;  ///< of simulation_
};

}  // namespace handcast::simulate
