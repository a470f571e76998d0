// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/side_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "ipc/base/clock.hpp"

namespace handcast::pose::stereo {
namespace {

/// Images within this time have the same errors.
constexpr double kSideErrorsLast_s = 0.4;
/// From comparison to comparison, until the side is sure and then.
constexpr std::int64_t kOften_ns = 50'000'000, kRarely_ns = 400'000'000;
constexpr double kSure = 4, kMost = 8;
/// Of one comparison. Landmarks are less independent than their costs say: these differ by 12 to
/// 200 (3 where hands cross) between a hand and its mirror image, by 6 to 19 if the network took it
/// for the other one.
constexpr double kOfCosts = 0.5, kMostOfCosts = 4, kOfVote = 0.5;
/// Landmarks that fit neither hand say nothing; usual are 10 to 40.
constexpr double kFitsNeither = 60;

/// What an image adds to one of `before`, as a share; 0 if there is none.
double share_since(const std::optional<std::int64_t>& before, std::int64_t time_ns) {
  if (!before) return 0;
  return std::clamp(ns_to_seconds(time_ns - *before) / kSideErrorsLast_s, 0.0, 1.0);
}

}  // namespace

bool SideEvidence::is_due(std::int64_t time_ns) const {
  const auto every_ns = log_odds_ > -kSure ? kOften_ns : kRarely_ns;
  return !compared_ns_ || std::abs(time_ns - *compared_ns_) >= every_ns;
}

void SideEvidence::compare(std::int64_t time_ns, double cost, double cost_of_other,
                           int votes_for_other) {
  const double share = is_known_ ? share_since(compared_ns_, time_ns) : 1;
  compared_ns_ = time_ns;
  if (!std::isfinite(cost - cost_of_other) || std::min(cost, cost_of_other) > kFitsNeither) return;
  const double costs = std::clamp(kOfCosts * (cost - cost_of_other), -kMostOfCosts, kMostOfCosts);
  add(share * (costs + kOfVote * votes_for_other));
  is_known_ = true;
}

void SideEvidence::vote(std::int64_t time_ns, int votes_for_other) {
  add(share_since(voted_ns_, time_ns) * kOfVote * votes_for_other);
  voted_ns_ = time_ns;
}

void SideEvidence::forget() {
  log_odds_ = 0;
  is_known_ = false;
  voted_ns_.reset();
}

void SideEvidence::add(double log_odds) {
  log_odds_ = std::clamp(log_odds_ + log_odds, -kMost, kMost);
}

}  // namespace handcast::pose::stereo
