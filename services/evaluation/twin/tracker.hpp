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

/// The twin's model of a hand tracker: times, delays and errors of its samples
/// (`docs/method.md#twin`). The reported hand is scaled, displaced and rotated by constants; each
/// joint drifts slowly and has white noise. Pure functions of the settings, the seed and the
/// arguments.
class TrackerModel {
 public:
  /// Copies its arguments. `seed` selects the random errors; `person` is the shape of the true
  /// hands, from which the reported joint radii follow.
  TrackerModel(const config::TwinTracker& settings, int seed, const calib::Calibration& calibration,
               const renderer::HandShape& person);

  /// True time of sample `k`: periodic with a jitter of 3 % of the period (standard deviation).
  std::int64_t sample_ns(std::uint64_t k) const;
  /// Time at which sample `k` is available. Samples may overtake each other.
  std::int64_t arrival_ns(std::uint64_t k) const;
  /// Time of sample `k` by the tracker's clock.
  std::int64_t stamp_ns(std::uint64_t k) const;
  /// True if sample `k` holds no hands.
  bool lost(std::uint64_t k) const;
  /// The sample whose poses sample `k` reports: `k`, or an earlier one while the tracker is frozen.
  std::uint64_t shown_sample(std::uint64_t k) const;
  /// False while the tracker reports left hands as right ones and vice versa.
  bool knows_sides(std::uint64_t k) const;
  /// The pose that sample `k` reports for a hand whose true joints (tracker space) are `truth`.
  msg::HandPose report(std::uint64_t k, Side side, const JointFrames& truth) const;

 private:
  /// Constant error of the pose of one hand.
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
  /// The drift by side, joint and camera axis.
  std::array<std::array<std::array<Waves, 3>, msg::kJoints>, 2> waves_;
};

}  // namespace handcast::twin
