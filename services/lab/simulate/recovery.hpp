// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>

#include "config/sections/twin.hpp"
#include "services/lab/simulate/light_moment.hpp"

namespace handcast::simulate {

/// Time span of the faults of a twin, in seconds since the epoch.
struct FaultTime {
  double begins_s = 0;  ///< start of the first fault
  double ends_s = 0;    ///< end of the last fault
};

/// The time span of the timed faults; empty without any. Image faults that last for the whole run
/// are not timed.
std::optional<FaultTime> fault_time(const config::Twin& twin);
/// The same settings without the timed faults.
config::Twin without_faults(config::Twin twin);

/// Effect of a fault on the light, and the time it lasts. The light is good if its error exceeds
/// that of the run without the fault, at the same time, by at most kFelt of the usual error: the
/// error of a moving hand varies without any fault.
struct Recovery {
  double usual_mm = 0;  ///< median error of the run without the fault
  double worst_mm = 0;  ///< largest error after the start of the fault
  double dark_ms = 0;   ///< time without light on a hand after the start of the fault
  /// Time from the end of the fault until the light is good and stays good for kStays_s; empty if
  /// that does not happen.
  std::optional<double> recovery_ms;
  /// Detections with a hand between the last light of the fault and the first good light.
  std::optional<int> recovery_detections;
};

constexpr double kStays_s = 0.1;  ///< time for which the light must stay good
constexpr double kFelt = 0.5;  ///< largest additional error of good light, as a share of the usual

/// Measures the recovery. `moments` is the run with the fault, `clean` the same run without it,
/// frame by frame. Empty if the runs differ in length or the clean run has no light.
std::optional<Recovery> recovery_of(std::span<const LightMoment> moments,
                                    std::span<const LightMoment> clean, const FaultTime& fault);

/// {"begins_s", "ends_s", "usual_mm", "worst_mm", "dark_ms", "recovery_ms", "recovery_detections"};
/// null without a fault.
nlohmann::json to_json(const std::optional<FaultTime>& fault, std::span<const LightMoment> moments,
                       std::span<const LightMoment> clean);

}  // namespace handcast::simulate
