// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Tells a tracker that re-places its hand (after a freeze, a swap, a wrong finger) from a hand
/// that moves. Judged by what the samples before were like: a hand that has been shaken for a while
/// may be shaken on.
class Continuity {
 public:
  struct Sample {
    std::int64_t origin_ns;
    msg::HandPose pose;
  };

  /// Whether `next` cannot be where the motion from `before` (nullptr: unknown) over `last` led;
  /// learns from it where it can.
  bool broken(const Sample* before, const Sample& last, const Sample& next);

  /// Whether `next` shows a hand that moved a moment ago stopped dead to the last bit: then nothing
  /// was measured.
  static bool frozen(const Sample* before, const Sample& last, const msg::HandPose& next);

  /// After which a tracker is held for silent.
  std::int64_t patience_ns() const;

 private:
  std::int64_t interval_ns_ = 9'000'000;  ///< as samples usually follow each other
  float usual_m_s2_ = 0;                  ///< by how much joints usually miss an even motion
};

}  // namespace handcast::renderer
