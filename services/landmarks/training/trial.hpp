// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "config/rig.hpp"
#include "services/evaluation/twin/twin.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/training/dice.hpp"

namespace handcast::landmarks::training {

/// One picture to test detectors on: a frame of a recording as the twin's camera sees it, and what
/// a tracker would say. Image px.
struct Trial {
  renderer::Image<std::uint8_t> image;
  msg::Side side = msg::Side::left;
  Points truth_px{};
  Points
      tracker_px{};  ///< off by about a fifth of the palm, fingers bent wrongly by about 10 degrees
  Points other_pose_px{};        ///< as above, of a hand that is in another pose
  std::array<bool, 5> folded{};  ///< the finger's tip is nearer to its root than 0.8 of its length
};

/// Frames of one of the twin's motions (a recording's folder or builtin:NAME), evenly spaced. No
/// training image is made from a recording, and the person is the recording's.
class Trials {
 public:
  /// Errors: as of Twin::create.
  static Result<Trials> open(const std::string& motion, std::uint64_t seed);
  /// Number `i` of `count`; nothing where the motion has no hand then.
  std::optional<Trial> make(int i, int count);

 private:
  Trials(std::unique_ptr<twin::Twin> world, const calib::Calibration& calibration,
         std::uint64_t seed)
      : twin_(std::move(world)), calibration_(calibration), seed_(seed) {}

  std::uint64_t frame(int i, int count) const;
  std::optional<renderer::JointFrames> in_camera(int i, int count) const;
  Points image_px(const renderer::JointFrames& in_camera) const;

  std::unique_ptr<twin::Twin> twin_;
  calib::Calibration calibration_;
  std::uint64_t seed_;
  double duration_s_ = 0;
};

}  // namespace handcast::landmarks::training
