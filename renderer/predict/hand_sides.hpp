// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Corrects exchanged sides: sensors now and then report a left hand as the right one for a moment.
/// The sides of a message are exchanged if its hands are where the other hands are expected. A
/// sensor that contradicts the expectation for 400 ms is accepted as it is; so is one whose hands
/// are too close together to be distinguished. One thread.
class HandSides {
 public:
  /// Where each hand is expected, indexed by Side; empty if there is no such hand.
  template <class Place>
  using BySide = std::array<std::optional<Place>, 2>;

  /// The message with corrected sides. `expected`: the hands at the message's origin time.
  /// @{
  msg::HandPoses named(const msg::HandPoses& reported, const BySide<msg::HandPose>& expected);
  msg::Landmarks named(const msg::Landmarks& reported, const BySide<LandmarkPoints>& expected);
  /// @}

 private:
  /// Limits how long the sides of one sensor are exchanged.
  class Doubt {
   public:
    bool justified(std::int64_t time_ns, bool exchanged);

   private:
    std::optional<std::int64_t> since_ns_;
  };
  Doubt tracker_, detector_;
};

}  // namespace handcast::renderer
