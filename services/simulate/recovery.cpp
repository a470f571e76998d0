#include "services/simulate/recovery.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace handcast::simulate {
namespace {

bool spoils(const config::TwinImage& image) {
  return image.dark < 1 || image.saturated > 1 || image.holes > 0 || image.covered > 0 || image.face;
}

bool is_good(const LightMoment& moment, double bound_mm) { return !moment.dark && moment.error_mm <= bound_mm; }

/// Of sorted numbers.
double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// Errors before the fault, sorted.
std::vector<double> errors_before(std::span<const LightMoment> moments, double begins_s) {
  std::vector<double> errors;
  for (const auto& moment : moments)
    if (moment.seconds < begins_s && !moment.dark) errors.push_back(moment.error_mm);
  std::ranges::sort(errors);
  return errors;
}

/// From the fault's end to the begin of the first good stretch that is long enough.
std::optional<double> until_good_ms(std::span<const LightMoment> moments, double ends_s, double bound_mm) {
  std::optional<double> good_since_s;
  for (const auto& moment : moments) {
    if (moment.seconds < ends_s) continue;
    if (!is_good(moment, bound_mm)) {
      good_since_s.reset();
      continue;
    }
    if (!good_since_s) good_since_s = moment.seconds;
    if (moment.seconds - *good_since_s >= kStays_s) return 1e3 * (*good_since_s - ends_s);
  }
  return std::nullopt;
}

}  // namespace

std::optional<FaultTime> fault_time(const config::Twin& twin) {
  const auto& tracker = twin.tracker;
  const auto& detector = twin.detector;
  std::vector<config::Fault> faults{tracker.frozen,  tracker.lost,  tracker.wrong_finger,
                                    tracker.swapped, detector.lost, detector.wrong_finger};
  const bool all_the_time = twin.image.fault.lasting_s >= config::TwinImage().fault.lasting_s;
  if (spoils(twin.image) && !all_the_time) faults.push_back(twin.image.fault);
  std::erase_if(faults, [](const config::Fault& fault) { return fault.lasting_s <= 0; });
  if (faults.empty()) return std::nullopt;
  FaultTime time{faults.front().at_s, 0};
  for (const auto& fault : faults) {
    time.begins_s = std::min(time.begins_s, fault.at_s);
    time.ends_s = std::max(time.ends_s, fault.at_s + fault.lasting_s);
  }
  return time;
}

std::optional<Recovery> recovery_of(std::span<const LightMoment> moments, const FaultTime& fault) {
  const auto before = errors_before(moments, fault.begins_s);
  if (before.empty() || fault.begins_s - moments.front().seconds < kStays_s) return std::nullopt;
  Recovery recovery;
  recovery.usual_mm = at_share(before, 0.5);
  for (std::size_t i = 1; i < moments.size(); ++i) {
    if (moments[i].seconds < fault.begins_s) continue;
    if (moments[i].dark) {
      recovery.dark_ms += 1e3 * (moments[i].seconds - moments[i - 1].seconds);
    } else {
      recovery.worst_mm = std::max(recovery.worst_mm, moments[i].error_mm);
    }
  }
  recovery.recovery_ms = until_good_ms(moments, fault.ends_s, std::max(1.5 * recovery.usual_mm, at_share(before, 0.95)));
  return recovery;
}

nlohmann::json to_json(const std::optional<FaultTime>& fault, std::span<const LightMoment> moments) {
  const auto recovery = fault ? recovery_of(moments, *fault) : std::nullopt;
  if (!recovery) return nullptr;
  return {
      {"begins_s", fault->begins_s},    {"ends_s", fault->ends_s},
      {"usual_mm", recovery->usual_mm}, {"worst_mm", recovery->worst_mm},
      {"dark_ms", recovery->dark_ms},   {"recovery_ms", recovery->recovery_ms ? nlohmann::json(*recovery->recovery_ms) : nlohmann::json()}};
}

}  // namespace handcast::simulate
