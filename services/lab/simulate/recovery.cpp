// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/recovery.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "ipc/base/statistics.hpp"

namespace handcast::simulate {
namespace {

bool spoils(const config::TwinImage& image) {
  return image.dark < 1 || image.saturated > 1 || image.holes > 0 || image.covered > 0 ||
         image.face || image.object;
}

bool lasts_for_good(const config::Fault& fault) {
  return fault.lasting_s >= config::TwinImage().fault.lasting_s;
}

std::array<config::Fault*, 10> faults_of(config::Twin& twin) {
  auto& tracker = twin.tracker;
  auto& detector = twin.detector;
  return {&tracker.frozen,  &tracker.decaying, &tracker.lost,  &tracker.wrong_finger,
          &tracker.merged,  &tracker.swapped,  &detector.lost, &detector.wrong_finger,
          &detector.merged, &twin.image.fault};
}

/// Median error; empty if there was never light.
std::optional<double> usual_error_mm(std::span<const LightMoment> moments) {
  std::vector<double> errors;
  for (const auto& moment : moments)
    if (!moment.dark) errors.push_back(moment.error_mm);
  if (errors.empty()) return std::nullopt;
  return median(std::move(errors));
}

bool is_good(const LightMoment& moment, const LightMoment& clean, double usual_mm) {
  if (moment.dark || clean.dark) return moment.dark <= clean.dark;
  return moment.error_mm <= clean.error_mm + kFelt * usual_mm;
}

/// Index of the first light after `ends_s` from which on the light is good for kStays_s.
std::optional<std::size_t> first_good(std::span<const LightMoment> moments,
                                      std::span<const LightMoment> clean, double ends_s,
                                      double usual_mm) {
  std::optional<std::size_t> good_since;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (moments[i].seconds < ends_s) continue;
    if (!is_good(moments[i], clean[i], usual_mm)) {
      good_since.reset();
      continue;
    }
    if (!good_since) good_since = i;
    if (moments[i].seconds - moments[*good_since].seconds >= kStays_s) return good_since;
  }
  return std::nullopt;
}

/// The detections that had arrived for the last light before `ends_s`.
int detections_until(std::span<const LightMoment> moments, double ends_s) {
  int detections = 0;
  for (const auto& moment : moments)
    if (moment.seconds < ends_s) detections = moment.detections;
  return detections;
}

void measure_damage(std::span<const LightMoment> moments, double begins_s, Recovery& recovery) {
  for (std::size_t i = 1; i < moments.size(); ++i) {
    if (moments[i].seconds < begins_s) continue;
    if (moments[i].dark) {
      recovery.dark_ms += 1e3 * (moments[i].seconds - moments[i - 1].seconds);
    } else {
      recovery.worst_mm = std::max(recovery.worst_mm, moments[i].error_mm);
    }
  }
}

template <class Number>
nlohmann::json json_of(const std::optional<Number>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json();
}

}  // namespace

std::optional<FaultTime> fault_time(const config::Twin& twin) {
  config::Twin copy = twin;
  std::optional<FaultTime> time;
  for (const config::Fault* fault : faults_of(copy)) {
    if (fault->lasting_s <= 0) continue;
    if (fault == &copy.image.fault && (!spoils(twin.image) || lasts_for_good(*fault))) continue;
    const double ends_s = fault->at_s + fault->lasting_s;
    time = time ? FaultTime{std::min(time->begins_s, fault->at_s), std::max(time->ends_s, ends_s)}
                : FaultTime{fault->at_s, ends_s};
  }
  return time;
}

config::Twin without_faults(config::Twin twin) {
  for (config::Fault* fault : faults_of(twin))
    if (fault != &twin.image.fault || !lasts_for_good(*fault)) *fault = {};
  return twin;
}

std::optional<Recovery> recovery_of(std::span<const LightMoment> moments,
                                    std::span<const LightMoment> clean, const FaultTime& fault) {
  const auto usual_mm = usual_error_mm(clean);
  if (!usual_mm || clean.size() != moments.size()) return std::nullopt;
  Recovery recovery{.usual_mm = *usual_mm};
  measure_damage(moments, fault.begins_s, recovery);
  if (const auto good = first_good(moments, clean, fault.ends_s, *usual_mm)) {
    recovery.recovery_ms = 1e3 * (moments[*good].seconds - fault.ends_s);
    recovery.recovery_detections =
        moments[*good].detections - detections_until(moments, fault.ends_s);
  }
  return recovery;
}

nlohmann::json to_json(const std::optional<FaultTime>& fault, std::span<const LightMoment> moments,
                       std::span<const LightMoment> clean) {
  const auto recovery = fault ? recovery_of(moments, clean, *fault) : std::nullopt;
  if (!recovery) return nullptr;
  return {{"begins_s", fault->begins_s},
          {"ends_s", fault->ends_s},
          {"usual_mm", recovery->usual_mm},
          {"worst_mm", recovery->worst_mm},
          {"dark_ms", recovery->dark_ms},
          {"recovery_ms", json_of(recovery->recovery_ms)},
          {"recovery_detections", json_of(recovery->recovery_detections)}};
}

}  // namespace handcast::simulate
