// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "services/pose/lift/fit.hpp"
#include "services/pose/lift/skeleton.hpp"
#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {

/// A hand with fewer seen landmarks is not used.
inline constexpr int kFewestSeen = 8;

/// The landmarks of a hand with their weights: the detector's sigma, to which the differences
/// between hand and model are added, divided by its confidence. Empty if too few were seen, they
/// lie too close together, or a number is not finite.
std::optional<SeenHand> read(const msg::HandLandmarks& landmarks);

/// The root mean square distance of the landmarks from their mean, px: 45 to 65 mm on a hand.
double extent_px(const std::array<glm::dvec2, msg::kLandmarks>& px);

/// A hand as one view reports it.
struct ReportedHand {
  msg::Side side;   ///< which hand the detector takes it for
  double presence;  ///< 0..1
  SeenHand seen;    ///< its landmarks
};
/// The hands that each view reports.
using Reports = std::array<std::vector<ReportedHand>, kViews>;

/// Where a hand is expected in each view; empty: it is not followed.
using Expected = std::optional<std::array<Points, kViews>>;

/// For one hand of the person: which report of each view is this hand; -1: none.
using Match = std::array<int, kViews>;
/// By msg::Side.
using Matches = std::array<Match, msg::kMaxHands>;

/// How badly two reports fit one hand: the mean squared epipolar distance of their landmarks in
/// sigmas (each at most 9), and how unusual the triangulated palm's size is. 1 is usual for the
/// same hand. Infinite if the landmarks meet nowhere in front of the cameras. `skeleton`: of either
/// side.
double misfit_of(const Skeleton& skeleton, const Views& views, const SeenHand& first,
                 const SeenHand& second);

/// Which reports belong to which hand of the person. A hand that is followed is where it is
/// expected, whatever side the detectors take it for; of others the detectors' sides count.
/// Reports that fit no hand are left out.
Matches match(const Skeleton& skeleton, const Views& views, const Reports& reports,
              const std::array<Expected, msg::kMaxHands>& expected);

}  // namespace handcast::pose::stereo
