// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <utility>
#include <vector>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/finger_pose.hpp"
#include "services/lab/twin/motion.hpp"
#include "services/lab/twin/person.hpp"

namespace handcast::twin {
namespace {

/// Natural cubic splines of several channels over the same times: twice differentiable everywhere.
class Spline {
 public:
  /// An empty spline, which must not be evaluated.
  Spline() = default;
  /// `values` holds a row of `channels` numbers per time. At least two times, ascending.
  Spline(std::vector<double> times_s, std::vector<double> values, std::size_t channels);

  /// Writes all channels at a time to `out`. Before the first and after the last time: those
  /// values.
  void at(double time_s, double* out) const;
  /// Time from the first sample to the last.
  double duration_s() const { return times_s_.back() - times_s_.front(); }
  /// Numbers that at() writes.
  std::size_t channels() const { return channels_; }

 private:
  void solve_bends();

  std::vector<double> times_s_, values_;
  std::vector<double> bends_;  ///< second derivatives, in the layout of values_
  std::size_t channels_ = 0;
};

Spline::Spline(std::vector<double> times_s, std::vector<double> values, std::size_t channels)
    : times_s_(std::move(times_s)),
      values_(std::move(values)),
      bends_(values_.size(), 0.0),
      channels_(channels) {
  if (times_s_.size() > 2) solve_bends();
}

/// Solves the tridiagonal system h_i M_{i-1} + 2 (h_i + h_{i+1}) M_i + h_{i+1} M_{i+1} = 6
/// (slope_{i+1} - slope_i), M = 0 at both ends, by Thomas' algorithm.
void Spline::solve_bends() {
  const std::size_t last = times_s_.size() - 1;
  std::vector<double> upper(last + 1, 0.0);
  for (std::size_t i = 1; i < last; ++i) {
    const double before = times_s_[i] - times_s_[i - 1];
    const double after = times_s_[i + 1] - times_s_[i];
    const double pivot = 2 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    for (std::size_t c = 0; c < channels_; ++c) {
      const double* y = &values_[i * channels_ + c];
      const double slope_step = (y[channels_] - y[0]) / after - (y[0] - *(y - channels_)) / before;
      bends_[i * channels_ + c] =
          (6 * slope_step - before * bends_[(i - 1) * channels_ + c]) / pivot;
    }
  }
  for (std::size_t i = last - 1; i > 0; --i)
    for (std::size_t c = 0; c < channels_; ++c)
      bends_[i * channels_ + c] -= upper[i] * bends_[(i + 1) * channels_ + c];
}

void Spline::at(double time_s, double* out) const {
  const double t = std::clamp(time_s, times_s_.front(), times_s_.back());
  const auto next = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, t);
  const auto i = static_cast<std::size_t>(next - times_s_.begin()) - 1;
  const double h = times_s_[i + 1] - times_s_[i];
  const double b = (t - times_s_[i]) / h;
  const double a = 1 - b;
  const double bend_a = (a * a * a - a) * h * h / 6;
  const double bend_b = (b * b * b - b) * h * h / 6;
  const double* y = &values_[i * channels_];
  const double* m = &bends_[i * channels_];
  for (std::size_t c = 0; c < channels_; ++c)
    out[c] = a * y[c] + b * y[c + channels_] + bend_a * m[c] + bend_b * m[c + channels_];
}

using msg::kJoints;

constexpr std::size_t kJointChannels = 7;  ///< x y z, then the quaternion x y z w
/// Time before and after an end of the recording in which the hand brakes and turns back.
constexpr double kTurn_s = 0.15;

/// Recording time covered in the first `s` seconds after a turning point. Twice differentiable; at
/// full speed after kTurn_s, after which it lags 3/8 kTurn_s behind.
double way_from_turn(double s) {
  const double u = s / kTurn_s;
  return u < 1 ? kTurn_s * (0.75 * u * u - 0.125 * u * u * u * u) : s - 0.375 * kTurn_s;
}

/// Recording time that is shown at `time_s`, played forwards and backwards in turn.
double there_and_back(double duration_s, double time_s) {
  const double leg_s = duration_s + 0.75 * kTurn_s;
  const double phase = time_s - 2 * leg_s * std::floor(time_s / (2 * leg_s));
  const double from_start = std::min(phase, 2 * leg_s - phase);
  return from_start < leg_s / 2 ? way_from_turn(from_start)
                                : duration_s - way_from_turn(leg_s - from_start);
}

Spline spline_of(const std::vector<std::int64_t>& time_ns,
                 const std::vector<msg::HandPose>& poses) {
  constexpr std::size_t kChannels = kJoints * kJointChannels;
  std::vector<double> times_s, values;
  values.reserve(poses.size() * kChannels);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    times_s.push_back(ns_to_seconds(time_ns[i]));
    for (int j = 0; j < kJoints; ++j) {
      const auto& joint = poses[i].joints[j];
      values.insert(values.end(), joint.position_m.begin(), joint.position_m.end());
      // A quaternion and its negative are the same rotation: take the one nearer to the last
      // sample.
      double along = 1;
      if (i > 0) {
        const double* before = values.data() + values.size() - kChannels;
        along = 0;
        for (int c = 0; c < 4; ++c) along += before[c] * joint.orientation_xyzw[c];
      }
      for (const float q : joint.orientation_xyzw) values.push_back(along < 0 ? -q : q);
    }
  }
  return Spline(std::move(times_s), std::move(values), kChannels);
}

/// A recording is the output of a tracker: the lengths of its bones change by 2 mm (RMS) from
/// sample to sample, and its palm is a guess. The hand that moves here has the bones of one person.
class RecordedMotion final : public Motion {
 public:
  RecordedMotion(const recording::RecordedHands& recording, const config::Twin& settings)
      : RecordedMotion(recording, settings, recorded_shape(recording)) {}

  std::optional<JointFrames> at(Side side, double seconds) const override {
    const auto& hand = hands_[static_cast<std::size_t>(side)];
    if (!hand) return std::nullopt;
    std::array<double, kJoints * kJointChannels> values;
    hand->at(there_and_back(hand->duration_s(), seconds * speed_), values.data());
    JointFrames frames;
    for (int j = 0; j < kJoints; ++j) {
      const double* v = &values[j * kJointChannels];
      frames[j] = glm::mat4(glm::mat4_cast(glm::normalize(glm::dquat(v[6], v[3], v[4], v[5]))));
      frames[j][3] = {v[0], v[1], v[2], 1};
    }
    const auto s = static_cast<std::size_t>(side);
    frames[kWristJoint] = frames[kWristJoint] * recorded_from_person_[s];
    return with_bones_of(rest_[s], frames);
  }

  const renderer::HandShape& shape() const override { return shape_; }

 private:
  RecordedMotion(const recording::RecordedHands& recording, const config::Twin& settings,
                 const renderer::HandShape& recorded)
      : speed_(settings.speed), shape_(person_of(recorded, settings.shape, settings.seed)) {
    for (const Side side : {Side::left, Side::right}) {
      const auto s = static_cast<std::size_t>(side);
      rest_[s] = rest_pose(side, shape_);
      recorded_from_person_[s] =
          glm::mat4(palm_axes(rest_pose(side, recorded)) * glm::transpose(palm_axes(rest_[s])));
      if (!recording.hands[s].empty()) hands_[s] = spline_of(recording.time_ns, recording.hands[s]);
    }
  }

  double speed_;
  renderer::HandShape shape_;
  std::array<JointFrames, 2> rest_{};
  std::array<glm::mat4, 2> recorded_from_person_{};  ///< axes of the wrist
  std::array<std::optional<Spline>, 2> hands_;
};

}  // namespace

std::unique_ptr<Motion> make_recorded_motion(const recording::RecordedHands& recording,
                                             const config::Twin& settings) {
  return std::make_unique<RecordedMotion>(recording, settings);
}

}  // namespace handcast::twin
