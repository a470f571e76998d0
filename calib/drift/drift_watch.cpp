// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/drift_watch.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace handcast::calib {
namespace {

/// What a tracker and a detector do with a person's hands wherever they are; different for each.
constexpr double kPerson_m = 0.0006, kPerson_rad = 0.0026;
/// Of what was known before, when the next person comes.
constexpr double kPastKept = 0.7;
constexpr int kLeastPlaces = 6;
/// The square of a drift in standard deviations from which on it is beyond doubt. Without a drift
/// it was at most 1.9 for 20 persons on the twin, because DriftFit allows for larger errors; with
/// one of 5 mm and 1 degree at least 15.
constexpr double kSure = 12;
/// A warning ends below this share of the limits.
constexpr double kOver = 0.7;

Motion person_errors() {
  Motion errors;
  errors << kPerson_rad, kPerson_rad, kPerson_rad, kPerson_m, kPerson_m, kPerson_m;
  return errors;
}

/// Of the rotation and the shift across the axis.
double surprise(const LikelyMotion& likely) {
  constexpr int kSeen = 5;
  const Eigen::Matrix<double, kSeen, 1> part = likely.motion.head<kSeen>();
  const Eigen::Matrix<double, kSeen, kSeen> covariance =
      likely.covariance.topLeftCorner<kSeen, kSeen>();
  return part.dot(covariance.ldlt().solve(part));
}

/// Standard deviation of a vector's length, to first order.
template <int kCount>
double deviation(const LikelyMotion& likely, int first) {
  return std::sqrt(likely.covariance.template block<kCount, kCount>(first, first).trace() / kCount);
}

}  // namespace

DriftWatch::DriftWatch(const Calibration& calibration, const DriftLimits& limits)
    : calibration_(calibration), limits_(limits) {}

void DriftWatch::add(std::size_t side, std::int64_t time_ns, const TrackedHand& hand) {
  part_with_persons(time_ns);
  hands_[side].still.add(time_ns, hand);
}

bool DriftWatch::add(std::size_t side, std::int64_t time_ns, const SeenHand& seen) {
  auto& [still, fit] = hands_[side];
  const auto held = still.add(time_ns, seen);
  if (!held) return false;
  const glm::dvec3 place_m(calibration_.camera_from_tracker *
                           glm::dvec4(middle_of(held->tracked), 1));
  if (!pivot_m_) pivot_m_ = place_m;
  if (!fit) fit.emplace(calibration_, *pivot_m_);
  if (!fit->add(*held)) return false;
  places_m_ += place_m;
  ++drift_.places;
  judge();
  return true;
}

/// When no hand has been there for a while, the next one is another person's.
void DriftWatch::part_with_persons(std::int64_t time_ns) {
  const bool are_gone =
      std::ranges::all_of(hands_, [&](const Hand& hand) { return hand.still.is_gone(time_ns); });
  if (!are_gone || std::ranges::none_of(hands_, [](const Hand& h) { return h.fit.has_value(); }))
    return;
  past_.information *= kPastKept;
  past_.weighted *= kPastKept;
  past_ += of_persons();
  for (auto& hand : hands_) hand = {};
}

KnownMotion DriftWatch::of_persons() const {
  KnownMotion known;
  for (const auto& hand : hands_)
    if (hand.fit) known += hand.fit->motion().with_error(person_errors());
  return known;
}

void DriftWatch::judge() {
  auto known = past_;
  known += of_persons();
  const auto middle_m = places_m_ / static_cast<double>(drift_.places);
  const auto found = likely(known).about(middle_m - *pivot_m_);
  const auto& m = found.motion;
  drift_.pivot_m = middle_m;
  drift_.turn_rad = {m[0], m[1], m[2]};
  drift_.shift_m = {m[3], m[4], m[5]};
  drift_.across_mm = 1e3 * std::hypot(m[3], m[4]);
  drift_.turn_deg = glm::degrees(glm::length(drift_.turn_rad));
  drift_.across_sd_mm = 1e3 * deviation<2>(found, 3);
  drift_.turn_sd_deg = glm::degrees(deviation<3>(found, 0));
  drift_.evidence = surprise(found);
  const double factor = drift_.moved ? kOver : 1;
  const bool is_far =
      drift_.across_mm > factor * limits_.warn_mm || drift_.turn_deg > factor * limits_.warn_deg;
  drift_.moved = drift_.places >= kLeastPlaces && is_far && drift_.evidence > factor * kSure;
}

}  // namespace handcast::calib
