// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>

#include "config/sections/cascade.hpp"
#include "renderer/base/recent.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/predict/continuity.hpp"

namespace handcast::renderer {

/// The recent poses of one hand as a function of time: interpolated between the samples, predicted
/// after the newest one up to a limit. Positions are interpolated linearly, orientations by
/// normalised linear interpolation of quaternions. Samples may arrive late or out of order. One
/// thread.
class PoseHistory {
 public:
  /// Without samples. `span_ns`: samples older than the newest by more than this are dropped.
  explicit PoseHistory(const config::Predict& settings, std::int64_t span_ns = 250'000'000);
  /// Predicts with other settings from now on.
  void adjust(const config::Predict& settings) { settings_ = settings; }

  /// How a sample relates to the ones before it.
  enum class Pushed {
    goes_on,  ///< it continues the motion
    /// The tracker jumped, or returned after a gap. Older samples are dropped; no velocity is
    /// derived across the jump.
    begins_anew,
    /// The sample is ignored: it is not finite, repeats a pose (Continuity::frozen()), or is older
    /// than begins_ns().
    not_measured,
  };
  /// Adds a sample; it replaces one with the same time.
  Pushed push(std::int64_t origin_ns, const msg::HandPose& pose);

  /// True if there is no sample.
  bool empty() const { return samples_.empty(); }
  /// Time of the newest sample; 0 if there is none.
  std::int64_t newest_ns() const;
  /// Time of the last jump, the lowest value if there was none. No sample is older.
  std::int64_t begins_ns() const { return begins_ns_; }
  /// False after a jump until three samples have arrived: the velocity is not known yet.
  bool settled() const { return since_jump_ >= kSettled; }
  /// The tracker counts as silent after this long without a sample.
  std::int64_t patience_ns() const { return continuity_.patience_ns(); }

  /// The pose at `time_ns`, tracker space. Empty if there is no sample or the newest one is more
  /// than `lost_ns` older. Before the oldest sample: the oldest. After the newest: by
  /// config::Predict::method, joint by joint, no farther than limit_ms:
  ///
  /// - hold: the newest pose.
  /// - velocity: the constant velocity from the newest sample that is at least 6 ms older. A joint
  /// that was slower than
  ///   still_mm_s over the last 50 ms rests at its mean over them instead, so that a still hand is
  ///   drawn without the noise of the samples; up to twice that speed the two are blended.
  /// - acceleration: the same with the velocity of steps_ahead() and the acceleration of the three
  ///   newest samples, as far as it exceeds the noise of the tracker (share_beyond_noise()): that
  ///   of the palm, whose mean has less noise, plus that of each joint relative to it.
  std::optional<msg::HandPose> at(std::int64_t time_ns, std::int64_t lost_ns = 200'000'000) const;

 private:
  using Sample = Continuity::Sample;
  /// Motion of one joint over the last 50 ms.
  struct Stillness {
    float speed_m_s = 0;  ///< largest distance from the newest sample, divided by the 50 ms
    glm::vec3 mean_m{0};
    glm::quat mean_turn{1, 0, 0, 0};
  };
  static constexpr int kSettled = 3;
  static constexpr std::size_t kExpected = 64;  ///< samples of 250 ms at 250 Hz

  bool breaks(const Sample& sample);
  Stillness stillness(int joint) const;
  void judge_stillness();
  msg::HandPose predicted(std::int64_t time_ns) const;
  /// The newest sample that is at least `by_ns` before `sample`; nullptr if there is none.
  const Sample* earlier_than(const Sample& sample, std::int64_t by_ns) const;
  std::array<glm::vec3, msg::kJoints> accelerated_m(const Sample& newest, const Sample& base,
                                                    std::int64_t ahead_ns) const;

  config::Predict settings_;
  std::int64_t span_ns_;
  Recent<Sample> samples_{kExpected};              ///< by time
  std::array<Stillness, msg::kJoints> stillness_;  ///< of samples_
  Continuity continuity_;
  std::int64_t begins_ns_ = std::numeric_limits<std::int64_t>::min();
  int since_jump_ = kSettled;  ///< samples since the last jump, counted up to kSettled
};

}  // namespace handcast::renderer
