// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "config/rig.hpp"
#include "services/lab/training/dice.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/landmarks/geometry/points.hpp"

namespace handcast::landmarks::training {

/// One test picture for landmark models: a frame of a motion in the twin's camera, with true
/// landmarks and a simulated tracker's joints, in image pixels.
struct Trial {
  renderer::Image<std::uint8_t> image;  ///< the frame
  msg::Side side = msg::Side::left;     ///< which hand it shows
  Points truth_px{};                    ///< the true landmarks
  /// The simulated tracker's joints: displaced by about a fifth of the palm, fingers bent by about
  /// 10 degrees too much or too little.
  Points tracker_px{};
  Points other_pose_px{};        ///< the same errors on the hand of another frame
  std::array<bool, 5> folded{};  ///< the finger's tip is nearer to its root than 0.8 of its length
};

/// Frames of one of the twin's motions (a recording's folder or builtin:NAME) at equal intervals.
/// No training image shows the motion or the person of a recording. One thread.
class Trials {
 public:
  /// `mesh`: whose flesh is shown, as `twin.shape.mesh`. Any but our own mesh has widths of its
  /// own. Errors: those of Twin::create.
  static Result<Trials> open(const std::string& motion, std::uint64_t seed,
                             const std::string& mesh = "handcast");
  /// Picture `i` of `count`; empty if there is no hand at that time.
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
