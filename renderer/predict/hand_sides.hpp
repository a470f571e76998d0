// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Keeps each hand's identity: sensors take a left hand for a right one now and then, for a moment.
/// A hand that is reported where the other one should be is the other one. A sensor that goes on
/// saying so is believed after a while; so it is where the hands are too close together to tell.
class HandSides {
 public:
  template <class Place>
  using BySide =
      std::array<std::optional<Place>, 2>;  ///< where the hands should be; nothing: not in sight

  /// The same hands, each called what it is.
  msg::HandPoses named(const msg::HandPoses& reported, const BySide<msg::HandPose>& expected);
  msg::Landmarks named(const msg::Landmarks& reported, const BySide<LandmarkPoints>& expected);

 private:
  /// How long one sensor has been contradicting itself.
  class Doubt {
   public:
    bool justified(std::int64_t time_ns, bool exchanged);

   private:
    std::optional<std::int64_t> since_ns_;
  };
  Doubt tracker_, detector_;
};

}  // namespace handcast::renderer
