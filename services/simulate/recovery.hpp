#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "config/sections/twin.hpp"

namespace handcast::simulate {

/// When something goes wrong in a rig, in seconds since the epoch.
struct FaultTime {
  double begins_s = 0, ends_s = 0;
};

/// From the first to the last second of the faults that the settings time; none where there are none, or one without an end.
std::optional<FaultTime> fault_time(const config::Twin& twin);

/// The light at one moment.
struct LightMoment {
  double seconds = 0;
  double error_mm = 0;  ///< mean over the landmarks of the hand that is worst off
  bool dark = false;    ///< a hand that is there has no light at all
};

/// How much a fault did, and how long it was felt.
struct Recovery {
  double usual_mm = 0;                ///< median error before the fault
  double worst_mm = 0;                ///< largest error from its begin on
  double dark_ms = 0;                 ///< from its begin on, time without light on a hand
  std::optional<double> recovery_ms;  ///< from its end until the light is good and stays so for kStays_s; none: it was not again
};

constexpr double kStays_s = 0.1;

/// Good is an error of at most 1.5 times the usual one, or of what 95 of 100 moments before the fault had where that is more: a hand that
/// moves has better and worse moments by itself. None where less than kStays_s was seen before the fault.
std::optional<Recovery> recovery_of(std::span<const LightMoment> moments, const FaultTime& fault);

/// {"begins_s","ends_s","usual_mm","worst_mm","dark_ms","recovery_ms"}; null where there was no fault.
nlohmann::json to_json(const std::optional<FaultTime>& fault, std::span<const LightMoment> moments);

}  // namespace handcast::simulate
