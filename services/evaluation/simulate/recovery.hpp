// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>

#include "config/sections/twin.hpp"
#include "services/evaluation/simulate/light_moment.hpp"

namespace handcast::simulate {

/// When something goes wrong in a rig, in seconds since the epoch.
struct FaultTime {
  double begins_s = 0, ends_s = 0;
};

/// From the first to the last second of the faults that the settings time; none where there are
/// none, or one without an end.
std::optional<FaultTime> fault_time(const config::Twin& twin);
/// The same twin in a world where none of them happens.
config::Twin without_faults(config::Twin twin);

/// How much a fault did, and how long it was felt.
struct Recovery {
  double usual_mm = 0;                ///< median error of the run without the fault
  double worst_mm = 0;                ///< largest error from its begin on
  double dark_ms = 0;                 ///< from its begin on, time without light on a hand
  std::optional<double> recovery_ms;  ///< from its end until the light is good and stays so for
                                      ///< kStays_s; none: it was not again
  std::optional<int> recovery_detections;  ///< that the first good light knew, and the last one
                                           ///< during the fault did not
};

constexpr double kStays_s = 0.1;
constexpr double kFelt =
    0.5;  ///< of the usual error: what more than that is the fault's doing is not good

/// Good is a light that errs at most kFelt of the usual error more than at the same time in the
/// same run without the fault: a hand that moves has better and worse moments by itself, and
/// neither is the fault's. `clean` is that run, moment by moment; none where it was dark.
std::optional<Recovery> recovery_of(std::span<const LightMoment> moments,
                                    std::span<const LightMoment> clean, const FaultTime& fault);

/// {"begins_s","ends_s","usual_mm","worst_mm","dark_ms","recovery_ms","recovery_detections"}; null
/// where there was no fault.
nlohmann::json to_json(const std::optional<FaultTime>& fault, std::span<const LightMoment> moments,
                       std::span<const LightMoment> clean);

}  // namespace handcast::simulate
