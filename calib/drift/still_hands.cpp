// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/still_hands.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::calib {
namespace {

constexpr std::int64_t kStill_ns = 500'000'000;
constexpr std::int64_t kKept_ns = 1'000'000'000;
constexpr std::int64_t kGone_ns = 1'000'000'000;
/// Longer gaps between two samples or images end the moment.
constexpr std::int64_t kLongestGap_ns = 120'000'000;
/// A hand that is held in the air sways by 20 mm/s; the joints by a tracker wander on their own.
constexpr double kStillMiddle_m = 0.003, kStillJoints_m = 0.006;
/// Of the middle of the landmarks, in the image.
constexpr double kStillMiddle_px = 5;
/// Places that are nearer and turned by less are the same: their errors are, too.
constexpr double kNewPlace_m = 0.02, kNewTurn_rad = 0.14;

bool finite(const TrackedHand& hand) {
  return std::ranges::all_of(hand, [](const TrackedJoint& joint) {
    const auto& a = joint.axes;
    return std::isfinite(joint.at_m.x + joint.at_m.y + joint.at_m.z + a[0][0] + a[0][1] + a[0][2] +
                         a[1][0] + a[1][1] + a[1][2] + a[2][0] + a[2][1] + a[2][2]);
  });
}

std::optional<glm::dvec2> middle_of(const SeenHand& hand) {
  glm::dvec2 sum(0);
  double count = 0;
  for (const auto& point : hand) {
    if (!(point.sigma_px > 0)) continue;
    sum += point.undistorted_px;
    ++count;
  }
  constexpr double kLeast = 10;
  if (count < kLeast || !std::isfinite(sum.x + sum.y)) return std::nullopt;
  return sum / count;
}

/// Root of the mean square distance of the landmarks' middle from its mean.
double unrest_px(const std::vector<SeenHand>& hands) {
  glm::dvec2 sum(0);
  double squares = 0, count = 0;
  for (const auto& hand : hands) {
    const auto middle = middle_of(hand);
    if (!middle) continue;
    sum += *middle;
    squares += glm::dot(*middle, *middle);
    ++count;
  }
  if (count == 0) return INFINITY;
  return std::sqrt(std::max(squares / count - glm::dot(sum, sum) / (count * count), 0.));
}

template <class Kept>
void forget_before(std::deque<Kept>& kept, std::int64_t time_ns) {
  while (!kept.empty() && kept.front().time_ns < time_ns) kept.pop_front();
}

}  // namespace

void StillHands::add(std::int64_t time_ns, const TrackedHand& hand) {
  if (!finite(hand)) {
    samples_.clear();
    return;
  }
  if (!samples_.empty()) {
    const auto since_ns = time_ns - samples_.back().time_ns;
    if (since_ns <= 0) return;
    if (since_ns > kLongestGap_ns) samples_.clear();
  }
  samples_.push_back({time_ns, hand});
  forget_before(samples_, time_ns - kKept_ns);
}

bool StillHands::is_gone(std::int64_t time_ns) const {
  return samples_.empty() || time_ns - samples_.back().time_ns > kGone_ns;
}

/// Between two samples.
std::optional<TrackedHand> StillHands::tracked_at(std::int64_t time_ns) const {
  const auto next = std::ranges::lower_bound(samples_, time_ns, {}, &Sample::time_ns);
  if (next == samples_.end() || next == samples_.begin()) return std::nullopt;
  const auto& [before_ns, before] = *(next - 1);
  const double share =
      static_cast<double>(time_ns - before_ns) / static_cast<double>(next->time_ns - before_ns);
  auto hand = share < 0.5 ? before : next->hand;
  for (std::size_t i = 0; i < kHandPoints; ++i)
    hand[i].at_m = glm::mix(before[i].at_m, next->hand[i].at_m, share);
  return hand;
}

std::optional<HeldHand> StillHands::add(std::int64_t time_ns, const SeenHand& seen) {
  const auto tracked = tracked_at(time_ns);
  if (!tracked || !middle_of(seen)) return std::nullopt;
  if (!pairs_.empty()) {
    const auto since_ns = time_ns - pairs_.back().time_ns;
    if (since_ns <= 0) return std::nullopt;
    if (since_ns > kLongestGap_ns) pairs_.clear();
  }
  pairs_.push_back({time_ns, *tracked, seen});
  forget_before(pairs_, time_ns - kStill_ns - kLongestGap_ns);
  if (pairs_.back().time_ns - pairs_.front().time_ns < kStill_ns) return std::nullopt;
  auto hand = held();
  if (!hand || !is_new(hand->tracked)) return std::nullopt;
  last_ = hand->tracked;
  return hand;
}

/// The hand of the pairs, if it was still.
std::optional<HeldHand> StillHands::held() const {
  std::vector<TrackedHand> tracked;
  std::vector<SeenHand> seen;
  for (const auto& pair : pairs_) {
    tracked.push_back(pair.tracked);
    seen.push_back(pair.seen);
  }
  const auto unrest = unrest_of(tracked);
  if (unrest.middle_m > kStillMiddle_m || unrest.joints_m > kStillJoints_m ||
      unrest_px(seen) > kStillMiddle_px)
    return std::nullopt;
  return HeldHand{pairs_.back().time_ns, mean_of(tracked), mean_of(seen)};
}

bool StillHands::is_new(const TrackedHand& hand) const {
  if (!last_) return true;
  if (glm::distance(calib::middle_of(hand), calib::middle_of(*last_)) > kNewPlace_m) return true;
  const auto turn = glm::transpose((*last_)[0].axes) * hand[0].axes;
  const double cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2;
  return std::acos(std::clamp(cosine, -1., 1.)) > kNewTurn_rad;
}

}  // namespace handcast::calib
