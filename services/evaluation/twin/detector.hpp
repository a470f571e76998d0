// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::twin {

/// The landmark detector of the twin: true landmarks with white noise, late, at times none. Its own
/// idea of where a joint is counts as removed.
class DetectorModel {
 public:
  DetectorModel(const config::TwinDetector& settings, int seed, const calib::CameraModel& camera);

  std::int64_t age_ns(std::uint64_t run) const;  ///< from the middle of the exposure to the result
  bool lost(std::uint64_t run, std::int64_t origin_ns) const;
  std::int64_t stamp_ns(
      std::int64_t origin_ns) const;  ///< what the detector's clock says of a frame's time
  /// What run number `run` makes of the true landmarks (undistorted camera px) of `origin_ns`.
  /// Points outside the image have confidence 0.
  msg::HandLandmarks report(std::uint64_t run, msg::Side side,
                            const std::array<glm::vec2, msg::kLandmarks>& truth,
                            std::int64_t origin_ns) const;

 private:
  glm::dvec2 outlier_px(std::uint64_t run, std::uint64_t draw) const;

  config::TwinDetector settings_;
  int seed_;
  calib::CameraModel camera_;
};

}  // namespace handcast::twin
