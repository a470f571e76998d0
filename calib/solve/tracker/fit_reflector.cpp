// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/fit_reflector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "calib/solve/tracker/observations.hpp"
#include "ipc/base/clock.hpp"

namespace handcast::calib {
namespace {

/// A fit with one hand.
struct OfHand {
  const TrackedTips* hand = nullptr;
  TrackerFit fit;
};

/// The fit of the hand with which most sightings fit.
Result<OfHand> best_of(const CameraModel& camera, std::span<const TrackedTips> hands,
                       std::span<const Sighting> sightings) {
  Result<OfHand> best = fail(Errc::bad_data, "The tracker has seen no hand.");
  for (const auto& hand : hands) {
    if (hand.samples.empty()) continue;
    auto fit = fit_tracker(camera, hand.samples, sightings);
    if (!fit) {
      if (!best) best = tl::make_unexpected(fit.error());
    } else if (!best || fit->inlier_share > best->fit.inlier_share) {
      best = OfHand{&hand, std::move(*fit)};
    }
  }
  return best;
}

std::vector<Sighting> as_of(std::span<const Sighting> sightings, int tip) {
  std::vector<Sighting> other(sightings.begin(), sightings.end());
  for (auto& sighting : other) sighting.point = tip;
  return other;
}

/// If the sightings fit another finger of the hand far better: a sentence.
std::optional<std::string> other_tip(const CameraModel& camera, const TrackedTips& hand,
                                     std::span<const Sighting> sightings, double index_share) {
  constexpr double kClear = 0.15, kNeverSuspect = 0.85;
  if (index_share > kNeverSuspect) return std::nullopt;
  std::optional<int> best;
  double best_share = index_share + kClear;
  for (int tip = 0; tip < static_cast<int>(kTipNames.size()); ++tip) {
    if (tip == kIndexTip) continue;
    const auto fit = fit_tracker(camera, hand.samples, as_of(sightings, tip));
    if (!fit || fit->inlier_share < best_share) continue;
    best_share = fit->inlier_share;
    best = tip;
  }
  if (!best) return std::nullopt;
  return fmt::format(
      "The reflector seems to be on the {}: {:.0f} % of the sightings fit it, and {:.0f} % the "
      "index finger; put it on the index finger, and measure again.",
      kTipNames[static_cast<std::size_t>(*best)], 100 * best_share, 100 * index_share);
}

TrackerPose pose_of(const TrackerFit& fit) {
  return {glm::dmat3(fit.camera_from_tracker), glm::dvec3(fit.camera_from_tracker[3]),
          ns_to_seconds(fit.clock_offset_ns)};
}

/// Between the sightings and the index tip of a hand; NaN while the tracker does not see it.
std::vector<double> distances(const CameraModel& camera, const TrackedTips& hand,
                              std::span<const Sighting> sightings, const TrackerFit& fit) {
  const auto observed = observe(camera, hand.samples, sightings);
  return observed ? observed->distances_px(pose_of(fit)) : std::vector<double>();
}

/// If a good share of the sightings that do not fit one hand fit the other: a sentence.
std::optional<std::string> other_hand(const CameraModel& camera, std::span<const TrackedTips> hands,
                                      std::span<const Sighting> sightings, const OfHand& best) {
  constexpr double kFar_scales = 4;
  constexpr std::ptrdiff_t kLeast = 20;
  const double limit_px = kFar_scales * std::max(best.fit.inliers.median_px, 1.0);
  const auto near = [&](double distance) { return distance < limit_px; };
  const auto count_near = [&](const TrackedTips& hand) {
    return std::ranges::count_if(distances(camera, hand, sightings, best.fit), near);
  };
  const auto ours = count_near(*best.hand);
  for (const auto& hand : hands) {
    if (&hand == best.hand || hand.samples.empty()) continue;
    const auto fitting = count_near(hand);
    if (fitting < kLeast || 20 * fitting < ours) continue;
    return fmt::format(
        "{} sightings fit the {} hand instead of the {} one: the reflector was on "
        "the wrong hand for a while.",
        fitting, hand.side, best.hand->side);
  }
  return std::nullopt;
}

}  // namespace

Result<TrackerFit> fit_reflector(const CameraModel& camera, std::span<const TrackedTips> hands,
                                 std::span<const Sighting> sightings) {
  auto best = best_of(camera, hands, sightings);
  if (!best) return tl::make_unexpected(best.error());
  auto& findings = best->fit.findings;
  if (auto sentence = other_hand(camera, hands, sightings, *best))
    findings.insert(findings.begin(), std::move(*sentence));
  if (auto sentence = other_tip(camera, *best->hand, sightings, best->fit.inlier_share)) {
    findings.insert(findings.begin(), std::move(*sentence));
    best->fit.quality = Quality::poor;
  }
  return std::move(best->fit);
}

}  // namespace handcast::calib
