// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

namespace handcast::renderer {

/// A share of light, 0..1, that falls at once and rises from 0 to 1 in 30 ms. Target times must
/// ascend.
class Dimmer {
 public:
  /// The share for `target_ns`: `wanted`, or less if it is still rising. The first one is `wanted`.
  float towards(std::int64_t target_ns, float wanted);
  /// Sets the share to 0.
  void out(std::int64_t target_ns);

 private:
  float level_ = 1;
  std::optional<std::int64_t> last_ns_;  ///< empty before the first frame
};

/// How old the data of a sensor gets before the next ones come.
class Rhythm {
 public:
  /// The age that says that the next ones are late: 2.5 usual intervals after the usual age, at
  /// most 0.4 s. `data_ns`: the time of the newest.
  std::int64_t late_ns(std::int64_t target_ns, std::int64_t data_ns);

 private:
  std::int64_t newest_ns_ = 0, interval_ns_ = 0, age_ns_ = 0;
};

/// The share of its light that a hand gets, by the age of its sensor data. While the tracker is
/// silent, the light fades between 100 and 200 ms after the last sample. Landmarks that are at most
/// 80 ms old keep it, and it fades between 800 and 900 ms. A slow sensor's data may be older
/// (Rhythm). It returns in 30 ms.
class Presence {
 public:
  /// The light is out after a silence of the tracker of this length, with or without landmarks.
  static constexpr std::int64_t kLongest_ns = 900'000'000;

  /// The share for `target_ns`, 0..1. `sampled_ns`: time of the tracker's newest sample. `seen_ns`:
  /// origin of the newest detection; empty if no landmarks are used. Target times must ascend.
  float at(std::int64_t target_ns, std::int64_t sampled_ns, std::optional<std::int64_t> seen_ns);
  /// There is no hand at `target_ns`: its light is out.
  void no_hand(std::int64_t target_ns);

 private:
  Rhythm tracker_, detector_;
  Dimmer light_;
};

/// The share of its light that a hand gets, by what the camera shows. A hand that the mask no
/// longer shows (it left the image, something dark covers it, the lamp went out) fades out in 100
/// ms. A hand that was never shown is dark.
class Sight {
 public:
  /// The share for `target_ns`, 0..1. `seen`: the newest image shows the hand. Target times must
  /// ascend.
  float at(std::int64_t target_ns, bool seen);
  /// There is no hand at `target_ns`: its light is out.
  void no_hand(std::int64_t target_ns);

 private:
  std::optional<std::int64_t> seen_ns_;  ///< target time of the last frame that showed it
  Dimmer light_;
};

}  // namespace handcast::renderer
