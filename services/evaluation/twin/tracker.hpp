// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/hand/maker/hand_shape.hpp"
#include "services/evaluation/twin/random.hpp"

namespace handcast::twin {

using msg::Side;
using renderer::JointFrames;

/// The hand tracker of the twin: when it samples, when a sample arrives, and how wrong it is
/// (METHOD section 4). Its hand is a little too large, misplaced and turned; every joint drifts
/// slowly and trembles.
class TrackerModel {
 public:
  TrackerModel(const config::TwinTracker& settings, int seed, const calib::Calibration& calibration,
               const renderer::HandShape& person);

  std::int64_t sample_ns(
      std::uint64_t k) const;  ///< origin of sample k: regular, but for a jitter of 3 % of a period
  std::int64_t arrival_ns(std::uint64_t k) const;
  std::int64_t stamp_ns(std::uint64_t k) const;  ///< what the tracker's clock says of it
  bool lost(std::uint64_t k) const;
  /// The sample whose pose sample k repeats: itself, but while the tracker is frozen.
  std::uint64_t shown_sample(std::uint64_t k) const;
  /// What a person would call the hands of sample k is what the tracker calls them.
  bool knows_sides(std::uint64_t k) const;
  /// What sample k reports of a hand whose true joints (tracker space) were `truth`.
  msg::HandPose report(std::uint64_t k, Side side, const JointFrames& truth) const;

 private:
  /// How one hand is misplaced for good.
  struct Place {
    glm::dmat3 turn{1};
    glm::dvec3 offset_m{0};
  };
  static constexpr int kWaves = 6;
  struct Wave {
    double rad_s = 0, phase = 0;
  };
  using Waves = std::array<Wave, kWaves>;

  Place draw_place(Side side) const;
  void draw_waves(Side side);
  glm::dvec3 drift_m(Side side, int joint, double seconds, double distance_m) const;
  glm::dvec3 noise_m(std::uint64_t k, Side side, int joint) const;

  config::TwinTracker settings_;
  int seed_;
  double fx_px_;
  glm::dmat4 camera_from_tracker_;
  std::array<float, msg::kJoints> radius_m_;
  std::array<Place, 2> places_;
  std::array<std::array<std::array<Waves, 3>, msg::kJoints>, 2>
      waves_;  ///< by side, joint, camera axis
};

}  // namespace handcast::twin
