// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/pairing.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "ipc/base/clock.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr std::int64_t kLongAgo_ns = std::numeric_limits<std::int64_t>::min() / 2;

}  // namespace

Pairing::Pairing(const config::PoseStereo& settings)
    : apart_ns_(ms_to_ns(settings.pair_ms)),
      wait_ns_(ms_to_ns(settings.wait_ms)),
      sampled_ns_(kLongAgo_ns) {
  newest_ns_.fill(kLongAgo_ns);
}

void Pairing::push(int view, const msg::Landmarks& landmarks, std::int64_t now_ns) {
  if (landmarks.header.origin_ns <= newest_ns_[view]) return;
  newest_ns_[view] = landmarks.header.origin_ns;
  waiting_[view] = Waiting{landmarks, now_ns};
}

std::optional<Pair> Pairing::take(std::int64_t now_ns) {
  for (auto& waiting : waiting_)
    if (waiting && waiting->landmarks.header.origin_ns <= sampled_ns_ - apart_ns_) waiting.reset();
  if (waiting_[0] && waiting_[1]) {
    const std::int64_t later_ns =
        waiting_[1]->landmarks.header.origin_ns - waiting_[0]->landmarks.header.origin_ns;
    if (std::abs(later_ns) <= apart_ns_) {
      Pair pair{waiting_[0]->landmarks, waiting_[1]->landmarks};
      waiting_ = {};
      return given(pair);
    }
    // The older one has no partner: one that is as old would have come before.
    const int older = later_ns > 0 ? 0 : 1;
    Pair pair;
    pair[older] = waiting_[older]->landmarks;
    waiting_[older].reset();
    if (auto sample = given(pair)) return sample;
  }
  for (int view = 0; view < kViews; ++view) {
    if (!can_be_alone(view) || now_ns < waiting_[view]->arrived_ns + wait_ns_) continue;
    Pair pair;
    pair[view] = waiting_[view]->landmarks;
    waiting_[view].reset();
    return given(pair);
  }
  return std::nullopt;
}

/// The pair, unless its newest origin is not newer than that of the last sample.
std::optional<Pair> Pairing::given(const Pair& pair) {
  std::int64_t newest_ns = kLongAgo_ns;
  for (const auto& landmarks : pair)
    if (landmarks) newest_ns = std::max(newest_ns, landmarks->header.origin_ns);
  if (newest_ns <= sampled_ns_) return std::nullopt;
  sampled_ns_ = newest_ns;
  return pair;
}

std::optional<std::int64_t> Pairing::due_ns() const {
  std::optional<std::int64_t> due;
  for (int view = 0; view < kViews; ++view) {
    if (!can_be_alone(view)) continue;
    const std::int64_t alone_ns = waiting_[view]->arrived_ns + wait_ns_;
    due = std::min(due.value_or(alone_ns), alone_ns);
  }
  return due;
}

/// What is older than the last sample can only be a part of the next one.
bool Pairing::can_be_alone(int view) const {
  return waiting_[view] && waiting_[view]->landmarks.header.origin_ns > sampled_ns_;
}

}  // namespace handcast::pose::stereo
