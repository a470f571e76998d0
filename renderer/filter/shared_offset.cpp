// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/shared_offset.hpp"

#include <algorithm>
#include <functional>

#include "renderer/base/noise.hpp"
#include "renderer/base/similarity.hpp"

namespace handcast::renderer {
namespace {

constexpr float kSmoothing = 0.1f;       ///< share of a new detection
constexpr float kLargestSigma_px = 1e3;  ///< limit of the values accepted from a detector
/// Least standard deviation of the offsets about the shared ones, per axis. Chosen on the motions
/// open_close, wave and fist of the twin.
constexpr float kLeastSpread_px = 7;
constexpr float kLeastSpread_px2 = kLeastSpread_px * kLeastSpread_px;
/// An offset this far from the shared one has half the weight in it (Cauchy's weights): a finger
/// that the tracker has wrong does not move the others.
constexpr float kFarFromShared_px = 15;

float given_sigma_px(const msg::Landmark& point) {
  return point.sigma_px > 0 ? std::min(point.sigma_px, kLargestSigma_px) : 0.0f;
}

struct Part {
  int first, count;  ///< landmarks
};
constexpr std::array<Part, 6> kParts{
    {{0, 1}, {1, 4}, {5, 4}, {9, 4}, {13, 4}, {17, 4}}};  // the wrist, the fingers

/// The offsets of the whole hand: the weighted similarity of P onto P + offset, minus P, in one
/// round of reweighting. At least one offset must be known.
LandmarkPoints shared_offsets(const std::array<glm::vec2, kLandmarks>& offsets_px,
                              const std::array<bool, kLandmarks>& known,
                              const std::array<float, kLandmarks>& sigma_px,
                              const LandmarkPoints& tracker) {
  std::array<float, kLandmarks> weight{};
  LandmarkPoints seen = tracker;
  for (int i = 0; i < kLandmarks; ++i) {
    if (!known[i]) continue;
    weight[i] = share_beyond_noise(kLeastSpread_px2, sigma_px[i]);
    seen[i] += offsets_px[i];
  }
  Similarity hand = fit_similarity(tracker, seen, weight);
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::vec2 off = seen[i] - hand(tracker[i]);
    weight[i] *= share_beyond_noise(kFarFromShared_px * kFarFromShared_px, glm::length(off));
  }
  hand = fit_similarity(tracker, seen, weight);
  LandmarkPoints shared;
  for (int i = 0; i < kLandmarks; ++i) shared[i] = hand(tracker[i]) - tracker[i];
  return shared;
}

}  // namespace

void LandmarkSigmas::detection(const msg::HandLandmarks& seen) {
  for (int i = 0; i < kLandmarks; ++i) {
    if (!was_seen(seen.points[i])) continue;
    const float sigma_px = given_sigma_px(seen.points[i]);
    px_[i] = known_[i] && sigma_px > 0 ? px_[i] + kSmoothing * (sigma_px - px_[i]) : sigma_px;
    known_[i] = true;
  }
}

void shrink_to_shared(std::array<glm::vec2, kLandmarks>& offsets_px,
                      const std::array<bool, kLandmarks>& known,
                      const std::array<float, kLandmarks>& sigma_px,
                      const LandmarkPoints& tracker) {
  if (std::ranges::none_of(sigma_px, [](float sigma) { return sigma > 0; }) ||
      std::ranges::none_of(known, std::identity()))
    return;
  const auto shared_px = shared_offsets(offsets_px, known, sigma_px, tracker);
  for (const auto& [first, count] : kParts) {
    float spread_px2 = 0, members = 0;
    for (int i = first; i < first + count; ++i) {
      if (!known[i]) continue;
      const glm::vec2 off = offsets_px[i] - shared_px[i];
      spread_px2 += 0.5f * glm::dot(off, off) - sigma_px[i] * sigma_px[i];
      members += 1;
    }
    spread_px2 = std::max(spread_px2 / std::max(members, 1.0f), kLeastSpread_px2);
    for (int i = first; i < first + count; ++i)
      if (known[i])
        offsets_px[i] =
            glm::mix(shared_px[i], offsets_px[i], share_beyond_noise(spread_px2, sigma_px[i]));
  }
}

}  // namespace handcast::renderer
