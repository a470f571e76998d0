// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

namespace handcast::renderer {

/// A level of light that falls as it is wanted, and comes back in 30 ms. Target times ascend.
class Dimmer {
 public:
  float towards(std::int64_t target_ns, float wanted);
  void out(std::int64_t target_ns);

 private:
  float level_ = 1;
  std::optional<std::int64_t> last_ns_;  ///< nothing: the first frame has the hand as it is
};

/// How much of its light a hand is given, 1..0. What cannot be saved fades out: when the tracker
/// has been silent for a tenth of a second the light goes in another; landmarks that are still seen
/// carry it for most of a second. It comes back in 30 ms.
class Presence {
 public:
  static constexpr std::int64_t kLongest_ns =
      900'000'000;  ///< after a silence of this length the light is out, landmarks or not

  /// `sampled_ns`: the tracker's newest sample. `seen_ns`: of the landmarks that carry the hand, if
  /// any do. Target times ascend.
  float at(std::int64_t target_ns, std::int64_t sampled_ns, std::optional<std::int64_t> seen_ns);
  /// The hand is not in sight.
  void gone(std::int64_t target_ns);

 private:
  Dimmer light_;
};

/// The same for the camera's eye: a hand that the mask does not show any more (it left the image,
/// something dark came before it, the lamp went out) fades in a tenth of a second. A hand that was
/// never seen is dark.
class Sight {
 public:
  /// `seen`: the newest image shows the hand. Target times ascend.
  float at(std::int64_t target_ns, bool seen);
  /// The tracker has no hand.
  void gone(std::int64_t target_ns);

 private:
  std::optional<std::int64_t> seen_ns_;  ///< the last frame's target time for which it was seen
  Dimmer light_;
};

}  // namespace handcast::renderer
