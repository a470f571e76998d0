// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "tests/renderer/poses.hpp"

namespace handcast::bench {

/// What the sensors of a rig report of hands that sway at up to 0.6 m/s: the tracker 9 ms and the
/// landmarks 16 ms late and 5 px off. The hand files must exist.
class SwayingHands {
 public:
  /// One hand (the left one) or two.
  explicit SwayingHands(const calib::Calibration& rig, int hands = 1,
                        const renderer::samples::Pose& pose = renderer::samples::kOpen);

  /// Passes on all messages that have arrived by `now_ns`, since the last call.
  void deliver(renderer::Pipeline& pipeline, std::int64_t now_ns);
  /// The newest image at `now_ns`.
  renderer::TimedImage image(std::int64_t now_ns) const;

 private:
  struct Hand {
    renderer::Side side;
    renderer::JointFrames joints;
    float aside_m;
  };

  std::vector<msg::HandPose> poses_at(std::int64_t time_ns) const;
  renderer::Image<std::uint8_t> image_at(std::int64_t time_ns) const;
  msg::HandPoses reported(std::int64_t time_ns) const;
  msg::Landmarks detected(std::int64_t time_ns) const;

  calib::Calibration rig_;
  std::vector<Hand> hands_;
  std::vector<renderer::Image<std::uint8_t>> images_;  ///< made beforehand, because that is slow
  std::int64_t next_sample_ns_ = 0, next_detection_ns_ = 0;
};

/// The reference rig above hands `distance_m` away: the twin's are 0.73 m from the camera.
calib::Calibration rig_above_hands(double distance_m = 0.73);

}  // namespace handcast::bench
