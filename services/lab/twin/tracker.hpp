// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "services/lab/twin/finger_errors.hpp"
#include "services/lab/twin/random.hpp"
#include "services/lab/twin/sensor_clock.hpp"

namespace handcast::twin {

using msg::Side;
using renderer::JointFrames;

/// The true joints of one hand at a time since the epoch, in tracker space; empty if there is none.
using JointsAt = std::function<std::optional<JointFrames>(std::int64_t time_ns)>;

/// The twin's model of a hand tracker: times, delays and errors of its samples
/// (`docs/method.md#twin`). The reported hand is that of an earlier time, its fingers are bent
/// wrongly (FingerErrors), its joints are not where the person's are, and it is scaled, displaced
/// and rotated by constants; each joint drifts slowly and has white noise. Pure functions of the
/// settings, the seed and the arguments.
class TrackerModel {
 public:
  /// Copies its arguments. `seed` selects the random errors; `person` is the shape of the true
  /// hands, from which the reported joint radii follow.
  TrackerModel(const config::TwinTracker& settings, int seed, const calib::Calibration& calibration,
               const renderer::HandShape& person);

  /// True time of sample `k`: periodic with a jitter of 3 % of the period (standard deviation).
  std::int64_t sample_ns(std::uint64_t k) const;
  /// Time at which sample `k` is available. Samples may overtake each other, or arrive together.
  std::int64_t arrival_ns(std::uint64_t k) const;
  /// Time of sample `k` by the tracker's clock.
  std::int64_t stamp_ns(std::uint64_t k) const { return clock_.stamp_ns(k, sample_ns(k)); }
  /// True if sample `k` holds no hands.
  bool lost(std::uint64_t k) const;
  /// False while the tracker reports left hands as right ones and vice versa.
  bool knows_sides(std::uint64_t k) const;
  /// The pose that sample `k` reports of one hand; empty if there is no such hand.
  std::optional<msg::HandPose> report(std::uint64_t k, Side side, const JointsAt& truth) const;

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

  /// What drifts on its own: each joint, and then the palm and each finger as a whole.
  static constexpr int kDrifting = msg::kJoints + kFingers + 1;

  Place draw_place(Side side) const;
  void draw_waves(Side side);
  void draw_joint_offsets();
  std::int64_t alone_ns(std::uint64_t k) const;
  std::uint64_t shown_sample(std::uint64_t k) const;
  double sunk_share(std::uint64_t k) const;
  std::optional<JointFrames> lagging(std::int64_t time_ns, const JointsAt& truth) const;
  JointFrames seen(std::uint64_t k, std::uint64_t shown, Side side, const JointFrames& truth) const;
  msg::HandPose placed(std::uint64_t shown, Side side, const JointFrames& seen) const;
  glm::dvec3 waves_at(Side side, int drifting, double seconds) const;
  glm::dvec3 drift_m(Side side, int joint, double seconds, double distance_m) const;
  glm::dvec3 noise_m(std::uint64_t k, Side side, int joint) const;

  config::TwinTracker settings_;
  int seed_;
  double fx_px_;
  glm::dmat4 camera_from_tracker_;
  std::array<float, msg::kJoints> radius_m_;
  std::array<JointFrames, 2> rest_;  ///< the person's hands at rest, by side
  FingerErrors fingers_;
  SensorClock clock_;
  std::array<Place, 2> places_;
  /// By joint, in the axes of its bone on a left hand, metres.
  std::array<glm::dvec3, msg::kJoints> joint_offset_m_{};
  /// The drift by side, what drifts, and camera axis.
  std::array<std::array<std::array<Waves, 3>, kDrifting>, 2> waves_;
};

}  // namespace handcast::twin
