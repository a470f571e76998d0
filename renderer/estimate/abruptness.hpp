// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Who of tracker and detector changed a landmark's motion more.
enum class Abrupt : std::uint8_t { neither, tracker, detector };
using AbruptLandmarks = std::array<Abrupt, kLandmarks>;

/// A hand moves smoothly. If tracker and detector suddenly disagree on a landmark, the one whose
/// landmark has just changed its motion more is the one that errs, or has ceased to. One thread.
class Abruptness {
 public:
  /// Adds where the tracker and the detector have the landmarks at the time of an image. Until
  /// three images were close together, the tracker has just found the hand, so that all are its.
  AbruptLandmarks add(std::int64_t time_ns, const LandmarkPoints& tracker_px,
                      const LandmarkPoints& detector_px);
  /// Forgets the images.
  void forget() { before_.reset(), last_.reset(); }

 private:
  struct Glimpse {
    std::int64_t time_ns;
    LandmarkPoints tracker_px, detector_px;
  };
  std::optional<Glimpse> before_, last_;
};

}  // namespace handcast::renderer
