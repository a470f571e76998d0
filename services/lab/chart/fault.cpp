// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace handcast::chart {
namespace {

struct Kind {
  std::string_view setting, name;  ///< name: a format string for the setting times the scale
  bool passes = false;
  double scale = 1;
};

constexpr std::array kKinds{
    Kind{"twin.tracker.lost_s", "tracker silent, {:g} ms", true, 1e3},
    Kind{"twin.tracker.frozen_s", "tracker frozen, {:g} ms", true, 1e3},
    Kind{"twin.tracker.decaying_s", "tracker sinks to rest, {:g} ms", true, 1e3},
    Kind{"twin.tracker.wrong_finger_s", "tracker: wrong finger, {:g} ms", true, 1e3},
    Kind{"twin.tracker.merged_s", "tracker: fingers merged, {:g} ms", true, 1e3},
    Kind{"twin.tracker.swapped_s", "tracker: hands swapped, {:g} ms", true, 1e3},
    Kind{"twin.detector.lost_s", "landmarks lost, {:g} ms", true, 1e3},
    Kind{"twin.detector.wrong_finger_s", "landmarks: wrong finger, {:g} ms", true, 1e3},
    Kind{"twin.detector.merged_s", "landmarks: fingers merged, {:g} ms", true, 1e3},
    Kind{"twin.tracker.clock_skew_ms", "tracker clock {:+g} ms"},
    Kind{"twin.detector.clock_skew_ms", "detector clock {:+g} ms"},
    Kind{"twin.detector.outliers", "outliers, {:g} % of the landmarks", false, 100},
    Kind{"twin.detector.near_outliers", "outliers of 5-40 px, {:g} %", false, 100},
    Kind{"twin.image.dark", "image dark: {:g} % of the light", false, 100},
    Kind{"twin.image.saturated", "image saturated: {:g} times the light"},
    Kind{"twin.image.holes", "image with holes, {:g} % of the hand", false, 100},
    Kind{"twin.image.covered", "image covered, {:g} %", false, 100},
    Kind{"twin.image.face", "a face behind the hands"},
};

/// The kinds of the failures in the axes of a run, in the order of the paths.
std::vector<const Kind*> kinds_of(const Run& run) {
  std::vector<const Kind*> kinds;
  for (const auto& path : run.turned())
    if (const auto kind = std::ranges::find(kKinds, path, &Kind::setting); kind != kKinds.end())
      kinds.push_back(&*kind);
  return kinds;
}

/// "landmarks lost, 600 ms + tracker frozen, 600 ms".
std::string name_of(const Run& run, const std::vector<const Kind*>& kinds) {
  std::string name;
  for (const auto* kind : kinds) {
    const double value =
        number_of(run.setting(std::string(kind->setting))).value_or(0) * kind->scale;
    name += (name.empty() ? "" : " + ") + fmt::format(fmt::runtime(kind->name), value);
  }
  return name;
}

std::string motion_of(const Run& run) {
  auto motion = run.setting("twin.motion");
  motion.erase(0, motion.find_last_of(":/") + 1);
  std::ranges::replace(motion, '_', ' ');
  return motion;
}

std::optional<double> most_of(const Runs& runs, const std::string& column) {
  std::optional<double> most;
  for (const auto* run : runs)
    if (const auto value = run->metric(column)) most = std::max(most.value_or(*value), *value);
  return most;
}

Damage damage_of(const Runs& runs) {
  Damage damage{most_of(runs, "fault_worst_mm"),
                most_of(runs, "fault_recovery_ms"),
                most_of(runs, "fault_dark_ms"),
                mean_of(runs, "interior_mm_p95"),
                mean_of(runs, "coverage"),
                mean_of(runs, "spill"),
                most_of(runs, "foldovers"),
                runs.size(),
                0};
  for (const auto* run : runs)
    damage.never_good += run->metric("fault_worst_mm") && !run->metric("fault_recovery_ms");
  return damage;
}

/// The drawn runs of the plans with more axes than those of a ladder.
Runs laboratory(const Results& results) {
  std::map<std::string, bool> ladder;
  for (const auto& source : results.sources) ladder[source.plan] = source.ladder;
  return results.select(
      [&](const Run& run) { return !ladder[run.plan] && run.metric("interior_mm_p95"); });
}

}  // namespace

std::vector<Failure> failures_of(const Results& results) {
  std::vector<Failure> failures;
  std::vector<Runs> runs_of;
  for (const auto* run : laboratory(results)) {
    const auto kinds = kinds_of(*run);
    if (number_of(run->setting("twin.image.holes")) == 0) continue;
    if (kinds.empty() && (!run->turned().empty() || !run->setting("twin.speed").empty())) continue;
    const auto name = kinds.empty() ? motion_of(*run) : name_of(*run, kinds);
    const auto found = std::ranges::find(failures, name, &Failure::name);
    const auto at = static_cast<std::size_t>(found - failures.begin());
    if (found == failures.end()) {
      failures.push_back({name,
                          kinds.empty()           ? FailureKind::motion
                          : kinds.front()->passes ? FailureKind::passing
                                                  : FailureKind::lasting,
                          {}});
      runs_of.emplace_back();
    }
    runs_of[at].push_back(run);
  }
  for (std::size_t i = 0; i < failures.size(); ++i)
    for (const auto& variant : variants_of(runs_of[i]))
      failures[i].damage[variant] = damage_of(of_variant(runs_of[i], variant));
  std::ranges::stable_sort(failures, {}, &Failure::kind);
  return failures;
}

bool recovers_faster(const Damage& damage, const Damage& than) {
  if (damage.never_good > 0 || !damage.recovery_ms) return false;
  if (than.never_good > 0) return true;
  return than.recovery_ms && *damage.recovery_ms + kSameRecovery_ms < *than.recovery_ms;
}

}  // namespace handcast::chart
