// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "renderer/base/landmark_points.hpp"
#include "renderer/estimate/articulated_hand.hpp"

namespace handcast::renderer {

/// Who of tracker and detector changed a landmark's motion more.
enum class Abrupt : std::uint8_t { neither, tracker, detector };
using AbruptLandmarks = std::array<Abrupt, kLandmarks>;

/// What has changed abruptly since the image before.
struct AbruptChange {
  AbruptLandmarks landmarks{};
  Flexions snapped_rad{};  ///< by how much the tracker alone has bent the fingers
};

/// Where tracker and detector have a hand at the time of an image.
struct HandGlimpse {
  std::int64_t time_ns;
  LandmarkPoints tracker_px, detector_px;
  Flexions flexions_rad;  ///< of the tracker
};

/// A hand moves smoothly. If tracker and detector suddenly disagree on a landmark, the one whose
/// landmark has just changed its motion more is the one that errs, or has ceased to. If the tracker
/// bends a finger faster than fingers can, and the detector does not see it, the finger has not
/// moved. One thread.
class Abruptness {
 public:
  /// Adds an image. Until three of them were close together (0.1 s, or regular and 0.4 s), the
  /// tracker has just found the hand, so that all changes are its.
  AbruptChange add(const HandGlimpse& glimpse);
  /// Forgets the images.
  void forget() { *this = Abruptness(); }

 private:
  std::optional<HandGlimpse> before_, last_;  ///< without the snaps
  Flexions snapped_rad_{};                    ///< the sum of all
};

}  // namespace handcast::renderer
