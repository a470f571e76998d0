// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/image.hpp"
#include "services/landmarks/finder/region.hpp"

namespace handcast::landmarks {

/// Finds the landmarks of one hand in a region of an image: a network with its crop. What
/// HandFinder asks of it. One thread.
class LandmarkModel {
 public:
  virtual ~LandmarkModel() = default;

  /// Where to look for a hand that was seen a moment ago, or that the tracker has there.
  virtual Region region_around(const Points& points_px) const = 0;
  /// How often a hand is looked at that was not seen in the last image: again around what was seen
  /// there.
  virtual int first_looks() const = 0;
  /// Whether it knows a left hand from a right one; else it is told, and surer of the right answer.
  virtual bool tells_sides() const = 0;

  struct Seen {
    Points points_px{};                             ///< in the image
    std::array<float, msg::kLandmarks> sigma_px{};  ///< standard deviation per axis; 0: not known
    float presence = 0;                             ///< 0..1: that there is a hand
    float left_score = 0.5f;  ///< 0..1: that it is a left one, in an image that is not mirrored
  };
  /// In ns, on top of what they are.
  struct Times {
    std::int64_t crop_ns = 0, network_ns = 0;
  };
  /// `side`: what it is taken for; `tracker_px`: its joints in the image, where there is a tracker.
  /// Errors: bad_data.
  virtual Result<Seen> look(renderer::GreyView image, const Region& region, msg::Side side,
                            const std::optional<Points>& tracker_px, Times& times) = 0;
};

}  // namespace handcast::landmarks
