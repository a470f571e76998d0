// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/tracker/joint_convention.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/similarity.hpp"

namespace handcast::landmarks {
namespace {

constexpr std::array kDefinedAlike{3, 4, 6, 7, 8, 10, 11, 12, 14, 15, 16, 18, 19, 20};
constexpr std::array kDefinedApart{0, 1, 2, 5, 9, 13, 17};
constexpr float kSmallestPalm_px = 20;
constexpr float kRest_px = 4;
constexpr std::int64_t kRest_ns = 100'000'000, kLongestStep_ns = 50'000'000;

/// The hand's axes in the image, one palm length long.
struct HandFrame {
  glm::vec2 along, across;
  glm::vec2 to_image(glm::vec2 v) const { return v.x * along + v.y * across; }
  glm::vec2 to_hand(glm::vec2 v) const {
    return glm::vec2(glm::dot(v, along), glm::dot(v, across)) / glm::dot(along, along);
  }
};

std::optional<HandFrame> frame_of(const Points& points_px) {
  const glm::vec2 along = points_px[9] - points_px[0];
  if (!(glm::length(along) >= kSmallestPalm_px)) return std::nullopt;
  const glm::vec2 across(-along.y, along.x);
  const bool to_the_index = glm::dot(points_px[5] - points_px[17], across) >= 0;
  return HandFrame{along, to_the_index ? across : -across};
}

/// Aligns the points that network and tracker define alike.
renderer::Similarity similarity_of(const Points& from_px, const Points& to_px) {
  std::array<glm::vec2, kDefinedAlike.size()> from, to;
  for (std::size_t i = 0; i < from.size(); ++i) {
    from[i] = from_px[kDefinedAlike[i]];
    to[i] = to_px[kDefinedAlike[i]];
  }
  return renderer::fit_similarity(from, to);
}

}  // namespace

std::optional<Points> convention_residual(const Points& network_px, const Points& tracker_px) {
  const auto frame = frame_of(network_px);
  if (!frame || !is_finite(network_px) || !is_finite(tracker_px)) return std::nullopt;
  const renderer::Similarity similarity = similarity_of(tracker_px, network_px);
  Points residual{};
  for (const int i : kDefinedApart)
    residual[i] = frame->to_hand(network_px[i] - similarity(tracker_px[i]));
  return residual;
}

/// The offsets on which two measurements agree: four real captures against their tracker, and 150
/// images of the twin against its true joints. (The captures alone also give 0.15 along for the
/// thumb's lowest joint and 0.06 across for the wrist; the twin does not confirm that.)
const Points& JointConventionOffsets::table() {
  static const Points kTable = [] {
    Points offsets{};
    offsets[2] = {-0.09f, 0.0f};
    return offsets;
  }();
  return kTable;
}

Points JointConventionOffsets::to_tracker(const Points& network_px) const {
  const auto frame = frame_of(network_px);
  if (!frame) return network_px;
  Points moved = network_px;
  for (const int i : kDefinedApart) moved[i] -= frame->to_image(offsets_[i]);
  return moved;
}

bool JointConventionOffsets::rests(std::int64_t time_ns, const Points& tracker_px) {
  bool moved = false;
  for (std::size_t i = 0; i < tracker_px.size(); ++i)
    moved = moved || !(glm::distance(tracker_px[i], rest_px_[i]) < kRest_px);
  if (moved || rest_since_ns_ == 0) {
    rest_px_ = tracker_px;
    rest_since_ns_ = time_ns;
  }
  return time_ns - rest_since_ns_ >= kRest_ns;
}

void JointConventionOffsets::learn(std::int64_t time_ns, const Points& network_px,
                                   const Points& tracker_px) {
  const std::int64_t step_ns = std::clamp(time_ns - learnt_ns_, std::int64_t{0}, kLongestStep_ns);
  if (time_ns - learnt_ns_ > kLongestStep_ns)
    rest_since_ns_ = 0;  // the hand may have moved in the gap
  learnt_ns_ = time_ns;
  if (!rests(time_ns, tracker_px)) return;
  const auto residual = convention_residual(network_px, tracker_px);
  if (!residual) return;
  const float share = static_cast<float>(step_ns) * 1e-9f / kLearning_s;
  for (const int i : kDefinedApart) {
    const glm::vec2 learnt = offsets_[i] + share * ((*residual)[i] - offsets_[i]) - table()[i];
    offsets_[i] =
        table()[i] + learnt * std::min(1.0f, kReach / std::max(glm::length(learnt), kReach));
  }
}

}  // namespace handcast::landmarks
