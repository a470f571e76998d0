// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>

#include "config/sections/cascade.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/predict/continuity.hpp"

namespace handcast::renderer {

/// The recent poses of one hand, asked for at a time: interpolated inside the history, predicted
/// beyond it up to a stated limit. Positions are interpolated linearly, orientations by normalised
/// quaternion blending. Samples may come late or out of order.
class PoseHistory {
 public:
  /// `span_ns`: how far back samples are kept.
  explicit PoseHistory(const config::Predict& settings, std::int64_t span_ns = 250'000'000);

  /// What a sample was.
  enum class Pushed {
    goes_on,       ///< the hand moved
    begins_anew,   ///< the tracker jumped, or came back: what was before is forgotten, and no
                   ///< velocity reaches across
    not_measured,  ///< nothing is new: a number that is not finite, a frozen pose, older than where
                   ///< the history begins
  };
  /// A sample with the time of an older one replaces it.
  Pushed push(std::int64_t origin_ns, const msg::HandPose& pose);

  bool empty() const { return samples_.empty(); }
  std::int64_t newest_ns() const;                        ///< 0 where empty
  std::int64_t begins_ns() const { return begins_ns_; }  ///< of what is known nothing is older
  bool settled() const {
    return since_jump_ >= kSettled;
  }  ///< its velocity is known again after a jump
  std::int64_t patience_ns() const {
    return continuity_.patience_ns();
  }  ///< after this long without a sample the tracker is silent

  /// The hand at `time_ns`; nothing where the history is empty, or ends more than `lost_ns` before
  /// `time_ns`. Before the oldest sample: the oldest. Beyond the newest: by
  /// config::Predict::method, joint by joint. "velocity" goes on as between the two newest samples;
  /// a joint slower than still_mm_s over the last 50 ms rests at its mean over them instead (noise
  /// of the samples does not reach the light), fading over to motion up to twice that speed.
  /// "acceleration" bends that way by the acceleration of the three newest samples, as far as it
  /// stands out of the tracker's noise: of the whole hand first, whose mean is quieter, then of
  /// each joint against it.
  std::optional<msg::HandPose> at(std::int64_t time_ns, std::int64_t lost_ns = 200'000'000) const;

 private:
  using Sample = Continuity::Sample;
  /// What the recent samples say of one joint.
  struct Stillness {
    float speed_m_s = 0;  ///< largest displacement from the newest sample, over the window's length
    glm::vec3 mean_m{0};
    glm::quat mean_turn{1, 0, 0, 0};
  };
  static constexpr int kSettled = 3;

  bool breaks(const Sample& sample);
  Stillness stillness(int joint) const;
  void judge_stillness();
  msg::HandPose predicted(std::int64_t time_ns) const;
  const Sample* earlier_than(
      const Sample& sample) const;  ///< the newest that is far enough before it to tell a velocity
  std::array<glm::vec3, msg::kJoints> bends_m(const Sample& newest, const Sample& base,
                                              std::int64_t ahead_ns) const;

  config::Predict settings_;
  std::int64_t span_ns_;
  std::deque<Sample> samples_;
  std::array<Stillness, msg::kJoints> stillness_;  ///< as of samples_
  Continuity continuity_;
  std::int64_t begins_ns_ = std::numeric_limits<std::int64_t>::min();
  int since_jump_ = kSettled;  ///< samples, up to kSettled
};

}  // namespace handcast::renderer
