// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>

#include "renderer/base/resting_mean.hpp"
#include "services/landmarks/finder/found_hand.hpp"
#include "services/landmarks/geometry/points.hpp"

namespace handcast::landmarks {

/// Takes the trembling of the tracker out of the hints. Our network goes a part of the way to its
/// hint, so that the landmarks of a hand at rest would drift and snap with the tracker's joints.
/// One thread.
class SteadyHints {
 public:
  /// The hint of a hand in the next image, moved so that each joint is as far from its landmark as
  /// it was on the average, judged by the last image.
  Points steadied(msg::Side side, Points hint_px) const;
  /// Learns from the hands that were found in an image. `hints_px`: those of the tracker.
  void remember(std::span<const FoundHand> found, const Hints& hints_px, std::int64_t time_ns);
  /// Drops all images.
  void forget() { *this = SteadyHints(); }

 private:
  struct Hand {
    std::array<renderer::RestingMean, msg::kLandmarks> distances;
    Points passing_px{};  ///< the distances in the last image less their means
  };
  std::array<Hand, msg::kMaxHands> hands_{};
};

}  // namespace handcast::landmarks
