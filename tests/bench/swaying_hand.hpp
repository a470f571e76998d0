// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/pipeline/pipeline.hpp"

namespace handcast::bench {

/// What the sensors of the paper's rig report of one left hand `distance_m` away (0.9: some 45,000
/// px) that sways at up to 0.6 m/s: the tracker 9 ms and the landmarks 16 ms late and 5 px off.
class SwayingHand {
 public:
  explicit SwayingHand(double distance_m);

  /// The calibration of the rig.
  const calib::Calibration& calibration() const { return calibration_; }
  /// Passes on all messages that have arrived by `now_ns`, since the last call.
  void deliver(renderer::Pipeline& pipeline, std::int64_t now_ns);
  /// The newest image at `now_ns`.
  renderer::TimedImage image(std::int64_t now_ns) const;

 private:
  calib::Calibration calibration_;
  std::vector<renderer::Image<std::uint8_t>> images_;  ///< made beforehand, because that is slow
  std::int64_t next_sample_ns_ = 0, next_detection_ns_ = 0;
};

}  // namespace handcast::bench
