// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/presence.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

constexpr std::int64_t kFade_ns = 100'000'000, kReturn_ns = 30'000'000;
// Ages up to which data gives full light.
constexpr std::int64_t kHeld_ns = 100'000'000;     ///< a tracker sample without landmarks
constexpr std::int64_t kCarried_ns = 800'000'000;  ///< a tracker sample with landmarks
constexpr std::int64_t kSeen_ns = 80'000'000;      ///< the landmarks

static_assert(kCarried_ns + kFade_ns == Presence::kLongest_ns);

/// 1 up to `held_ns`, then smoothly to 0.
float faded(std::int64_t age_ns, std::int64_t held_ns) {
  const float t =
      std::clamp(static_cast<float>(age_ns - held_ns) / static_cast<float>(kFade_ns), 0.0f, 1.0f);
  return 1 - t * t * (3 - 2 * t);
}

}  // namespace

float Dimmer::towards(std::int64_t target_ns, float wanted) {
  const float rise = last_ns_
                         ? static_cast<float>(std::max<std::int64_t>(target_ns - *last_ns_, 0)) /
                               static_cast<float>(kReturn_ns)
                         : 1.0f;
  level_ = std::min(wanted, level_ + rise);
  last_ns_ = target_ns;
  return level_;
}

void Dimmer::out(std::int64_t target_ns) {
  level_ = 0;
  last_ns_ = target_ns;
}

std::int64_t Rhythm::late_ns(std::int64_t target_ns, std::int64_t data_ns) {
  constexpr std::int64_t kPause_ns = 400'000'000, kMemory = 4;  // data
  const auto interval_ns = data_ns - newest_ns_;
  if (newest_ns_ > 0 && interval_ns > 0 && interval_ns < kPause_ns) {
    interval_ns_ += (interval_ns - interval_ns_) / kMemory;
    age_ns_ += (target_ns - data_ns - age_ns_) / kMemory;
  }
  newest_ns_ = data_ns;
  return std::min(age_ns_ + 5 * interval_ns_ / 2, kPause_ns);
}

float Presence::at(std::int64_t target_ns, std::int64_t sampled_ns,
                   std::optional<std::int64_t> seen_ns) {
  const auto held_ns = std::max(kHeld_ns, tracker_.late_ns(target_ns, sampled_ns));
  float wanted = faded(target_ns - sampled_ns, held_ns);
  if (seen_ns)
    wanted = std::max(wanted,
                      std::min(faded(target_ns - sampled_ns, kCarried_ns),
                               faded(target_ns - *seen_ns,
                                     std::max(kSeen_ns, detector_.late_ns(target_ns, *seen_ns)))));
  return light_.towards(target_ns, wanted);
}

void Presence::no_hand(std::int64_t target_ns) { light_.out(target_ns); }

float Sight::at(std::int64_t target_ns, bool seen) {
  if (seen) seen_ns_ = target_ns;
  return light_.towards(target_ns, seen_ns_ ? faded(target_ns - *seen_ns_, 0) : 0.0f);
}

void Sight::no_hand(std::int64_t target_ns) {
  seen_ns_.reset();
  light_.out(target_ns);
}

}  // namespace handcast::renderer
