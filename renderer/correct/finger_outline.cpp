// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/finger_outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::renderer {
namespace {

constexpr float kMemory_s = 0.04f;             ///< of the averages
constexpr float kFade_s = 0.3f;                ///< in which an average that is not measured fades
constexpr float kLongestFingerStep_s = 0.02f;  ///< one frame does not count as more
constexpr float kLeastFrontal = 0.5f;          ///< hands seen from the edge hide their own fingers
constexpr float kFastestFinger_px_s = 1500;    ///< landmarks that move faster are blurred

// Of the prior: standard deviations of the displacements, in radii of a finger. They are what the
// landmarks of a finger share, what grows from the knuckle to the tip, and each one's own.
constexpr float kAcrossShared = 0.3f, kAcrossGrown = 0.25f, kAcrossOwn = 0.15f;
constexpr float kAlongShared = 0.2f, kAlongGrown = 0.2f, kAlongOwn = 0.1f;
constexpr float kSigma = 0.1f;  ///< of an average
/// Shares of the length of a finger at its landmarks.
constexpr std::array<float, 4> kPlace{0, 0.45f, 0.75f, 1};

constexpr float kHalfSection = 0.35f;  ///< edges that reach this share of a bone further are kept
constexpr float kLeastWeight = 0.3f;   ///< of a finger in its vertices
constexpr float kBeyondWeb = 0.85f;    ///< station of a proximal phalanx
constexpr float kThinnest_px = 3;
/// Of the radius. A side of the mask is within this of the drawn one; a side of the drawing is free
/// if nothing else is within this beyond it.
constexpr float kFarthestEdge = 0.8f, kEdgeMargin = 0.25f;
constexpr float kThinner = 0.75f, kWider = 1.35f;  ///< mask / drawing, of a finger's width
constexpr float kFoldedLength = 1;  ///< shorter phalanges, in radii, are seen from the end
constexpr float kPalmRadius = 1.6f, kBoneRadius = 0.9f;  ///< of what may cover a side

constexpr std::array<std::array<int, 2>, 8> kPalmBones{
    {{0, 1}, {0, 5}, {0, 9}, {0, 13}, {0, 17}, {5, 9}, {9, 13}, {13, 17}}};

/// The edges around a place of a phalanx. Of all joints of the finger: a section must not end at
/// the vertices that other phalanges move, too.
std::vector<MeshEdge> edges_at(const HandMesh& mesh, int knuckle, int landmark, float station) {
  const int first = msg::kJointOfLandmark[knuckle];
  const std::array finger{first, first + 1, first + 2, first + 3};
  const glm::vec3 start(mesh.rest[msg::kJointOfLandmark[landmark]][3]);
  const glm::vec3 way = glm::vec3(mesh.rest[msg::kJointOfLandmark[landmark + 1]][3]) - start;
  std::vector<bool> around(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const float along = glm::dot(mesh.positions[v] - start, way) / glm::dot(way, way);
    around[v] =
        std::abs(along - station) < kHalfSection && weight_of(mesh, v, finger) > kLeastWeight;
  }
  return edges_among(mesh, around);
}

std::vector<std::uint16_t> tip_of(const HandMesh& mesh, int last_phalanx) {
  const int joint = msg::kJointOfLandmark[last_phalanx];
  const std::array joints{joint, joint + 1};
  std::vector<std::uint16_t> vertices;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    if (weight_of(mesh, v, joints) > kLeastWeight)
      vertices.push_back(static_cast<std::uint16_t>(v));
  return vertices;
}

float square(float x) { return x * x; }

}  // namespace

FingerOutline::FingerOutline(const HandMesh& mesh) {
  for (int f = 0; f < kFingers; ++f) {
    Finger& finger = fingers_[f];
    finger.landmark = first_landmark(f);
    // The thumb's metacarpal is of the palm; a proximal phalanx is free beyond the web.
    for (int k = f == 0 ? 1 : 0; k < kMostBones; ++k) {
      const float station = k == 0 ? kBeyondWeb : 0.5f;
      finger.bones.push_back(
          {k, station, edges_at(mesh, finger.landmark, finger.landmark + k, station), {}});
    }
    finger.tip = tip_of(mesh, finger.landmark + 2);
  }
}

/// False if a phalanx of the finger folds back in the image: two phalanges share one outline.
bool FingerOutline::is_straight(const Finger& finger, const LandmarkPoints& px) {
  for (int i = finger.landmark; i + 2 < finger.landmark + kLandmarksOfFinger; ++i)
    if (!(glm::dot(px[i + 1] - px[i], px[i + 2] - px[i + 1]) > 0)) return false;
  return true;
}

std::optional<FingerOutline::Drawn> FingerOutline::drawn(const Finger& finger, const Bone& bone,
                                                         std::span<const glm::vec2> vertices_px,
                                                         const LandmarkPoints& landmarks_px) {
  const int start = finger.landmark + bone.first;
  const glm::vec2 from = landmarks_px[start], way = landmarks_px[start + 1] - from;
  const float length_px = glm::length(way);
  if (!(length_px > kThinnest_px)) return std::nullopt;
  const glm::vec2 along = way / length_px, across(-along.y, along.x);
  Axes axes{from, along, across};
  const Section section = section_of(bone.edges, vertices_px, axes, bone.station * length_px);
  const float half_px = 0.5f * (section.high_px - section.low_px);
  if (section.empty() || !(half_px > kThinnest_px) || length_px < kFoldedLength * half_px)
    return std::nullopt;
  axes.origin += bone.station * way + 0.5f * (section.low_px + section.high_px) * across;
  return Drawn{axes, half_px};
}

/// True if no part of the drawn hand but the phalanx at `landmark` and its neighbours is near.
bool FingerOutline::is_free(glm::vec2 place, int landmark, const LandmarkPoints& px) const {
  for (const auto& [start, end] : kPalmBones)
    if (from_bone_px(place, px, start, end) < kPalmRadius * radius_px_) return false;
  for (const Finger& finger : fingers_)
    for (int k = 0; k < kMostBones; ++k) {
      const int start = finger.landmark + k;
      const bool is_own =
          landmark >= finger.landmark && landmark < finger.landmark + kLandmarksOfFinger;
      if (is_own && std::abs(start - landmark) < 2) continue;
      if (from_bone_px(place, px, start, start + 1) < kBoneRadius * radius_px_) return false;
    }
  return true;
}

/// How far the middle of the mask is from the drawn one. Empty if a side is not seen, or the mask
/// is not as wide as a finger.
std::optional<float> FingerOutline::across(const Finger& finger, const Bone& bone,
                                           const Drawn& drawn, const LandmarkPoints& landmarks_px,
                                           GreyView mask) const {
  std::array<float, 2> wider_px{};
  for (std::size_t side = 0; side < 2; ++side) {
    const glm::vec2 way = side == 0 ? -drawn.axes.across : drawn.axes.across;
    const glm::vec2 beyond = drawn.axes.origin + way * (drawn.half_px + kEdgeMargin * radius_px_);
    if (!is_free(beyond, finger.landmark + bone.first, landmarks_px)) return std::nullopt;
    const auto edge = edge_px(mask, drawn.axes.origin, way, (1 + kFarthestEdge) * drawn.half_px);
    if (!edge || std::abs(*edge - drawn.half_px) > kFarthestEdge * drawn.half_px)
      return std::nullopt;
    wider_px[side] = *edge - drawn.half_px;
  }
  const float ratio = 1 + 0.5f * (wider_px[0] + wider_px[1]) / drawn.half_px;
  if (ratio < kThinner || ratio > kWider) return std::nullopt;
  return 0.5f * (wider_px[1] - wider_px[0]);
}

/// How far the mask reaches beyond the drawn tip.
std::optional<float> FingerOutline::along(const Finger& finger, const Drawn& drawn,
                                          std::span<const glm::vec2> vertices_px,
                                          const LandmarkPoints& landmarks_px, GreyView mask) const {
  float end_px = 0;
  for (const std::uint16_t v : finger.tip)
    end_px = std::max(end_px, glm::dot(vertices_px[v] - drawn.axes.origin, drawn.axes.along));
  if (end_px < drawn.half_px) return std::nullopt;  // seen from the end
  const glm::vec2 beyond =
      drawn.axes.origin + drawn.axes.along * (end_px + kEdgeMargin * radius_px_);
  if (!is_free(beyond, finger.landmark + 2, landmarks_px)) return std::nullopt;
  const float most_px = kFarthestEdge * radius_px_;
  const auto edge = edge_px(mask, drawn.axes.origin, drawn.axes.along, end_px + most_px);
  if (!edge || std::abs(*edge - end_px) > most_px) return std::nullopt;
  return *edge - end_px;
}

/// All phalanges as they are drawn. Their mean width becomes that of the fingers.
FingerOutline::DrawnFingers FingerOutline::look(std::span<const glm::vec2> vertices_px,
                                                const LandmarkPoints& landmarks_px) {
  DrawnFingers fingers;
  float sum_px = 0;
  int count = 0;
  for (std::size_t f = 0; f < fingers_.size(); ++f)
    for (std::size_t b = 0; b < fingers_[f].bones.size(); ++b) {
      fingers[f][b] = drawn(fingers_[f], fingers_[f].bones[b], vertices_px, landmarks_px);
      if (!fingers[f][b]) continue;
      sum_px += fingers[f][b]->half_px;
      ++count;
    }
  if (count > 0) radius_px_ = sum_px / static_cast<float>(count);
  return fingers;
}

/// Adds a difference that was seen with `moved_by_px` already in the drawing. From the drawing
/// without displacement, too, the mask must not be far: a drawing that does not follow its
/// displacement would let it grow from frame to frame.
void FingerOutline::add(const std::optional<float>& seen_px, float moved_by_px, float part,
                        Lasting& average) const {
  if (seen_px && std::abs(*seen_px + moved_by_px) < kFarthestEdge * radius_px_)
    average.add(*seen_px + moved_by_px, part);
}

void FingerOutline::measure(std::int64_t time_ns, std::span<const glm::vec2> vertices_px,
                            const LandmarkPoints& landmarks_px, GreyView mask) {
  const float step_s =
      std::clamp(static_cast<float>(ns_to_seconds(time_ns - last_ns_)), 0.0f, 10 * kFade_s);
  const float part = 1 - std::exp(-std::min(step_s, kLongestFingerStep_s) / kMemory_s),
              kept = std::exp(-step_s / kFade_s);
  const DrawnFingers all_drawn = look(vertices_px, landmarks_px);
  const bool is_shown = is_open(landmarks_px) && frontal_share(landmarks_px) > kLeastFrontal;
  for (std::size_t f = 0; f < fingers_.size(); ++f) {
    Finger& finger = fingers_[f];
    finger.along_px.fade(kept);
    const bool is_measured = is_shown && is_straight(finger, landmarks_px);
    for (std::size_t b = 0; b < finger.bones.size(); ++b) {
      Bone& bone = finger.bones[b];
      bone.across_px.fade(kept);
      const int end = finger.landmark + bone.first + 1;
      const float moved_px = glm::distance(landmarks_px[end], last_px_[end]);
      const auto& drawn = all_drawn[f][b];
      if (!is_measured || !drawn || !(moved_px <= kFastestFinger_px_s * step_s)) continue;
      add(across(finger, bone, *drawn, landmarks_px, mask),
          glm::mix(finger.across[bone.first], finger.across[bone.first + 1], bone.station), part,
          bone.across_px);
      if (bone.first + 1 == kMostBones)
        add(along(finger, *drawn, vertices_px, landmarks_px, mask), finger.along.back(), part,
            finger.along_px);
    }
    solve_across(finger);
    solve_along(finger);
  }
  last_ns_ = time_ns;
  last_px_ = landmarks_px;
}

/// The most likely displacements, by Kalman's update for each phalanx.
void FingerOutline::solve_across(Finger& finger) const {
  std::array<std::array<float, kLandmarksOfFinger>, kLandmarksOfFinger> covariance;
  for (int i = 0; i < kLandmarksOfFinger; ++i)
    for (int j = 0; j < kLandmarksOfFinger; ++j)
      covariance[i][j] = square(radius_px_) *
                         (square(kAcrossShared) + square(kAcrossGrown) * kPlace[i] * kPlace[j] +
                          (i == j ? square(kAcrossOwn) : 0));
  auto& result = finger.across;
  result = {};
  for (const Bone& bone : finger.bones) {
    if (!(bone.across_px.share > 0)) continue;
    const int k = bone.first;
    const auto at_station = [&](const std::array<float, kLandmarksOfFinger>& of_finger) {
      return glm::mix(of_finger[k], of_finger[k + 1], bone.station);
    };
    std::array<float, kLandmarksOfFinger> gain;
    for (int i = 0; i < kLandmarksOfFinger; ++i) gain[i] = at_station(covariance[i]);
    const float variance = at_station(gain) + square(kSigma * radius_px_) / bone.across_px.share;
    const float left_px = bone.across_px.value - at_station(result);
    for (int i = 0; i < kLandmarksOfFinger; ++i) result[i] += gain[i] / variance * left_px;
    for (int i = 0; i < kLandmarksOfFinger; ++i)
      for (int j = 0; j < kLandmarksOfFinger; ++j) covariance[i][j] -= gain[i] * gain[j] / variance;
  }
}

/// The most likely displacements, given that of the tip.
void FingerOutline::solve_along(Finger& finger) const {
  finger.along = {};
  if (!(finger.along_px.share > 0)) return;
  const float at_tip = square(kAlongShared) + square(kAlongGrown) + square(kAlongOwn),
              variance = at_tip + square(kSigma) / finger.along_px.share;
  for (int i = 0; i < kLandmarksOfFinger; ++i)
    finger.along[i] = (square(kAlongShared) + square(kAlongGrown) * kPlace[i] +
                       (i + 1 == kLandmarksOfFinger ? square(kAlongOwn) : 0)) /
                      variance * finger.along_px.value;
}

LandmarkPoints FingerOutline::moved(const LandmarkPoints& landmarks_px) const {
  LandmarkPoints result = landmarks_px;
  for (const Finger& finger : fingers_)
    for (int k = 0; k < kLandmarksOfFinger; ++k) {
      const int i = finger.landmark + k;
      const glm::vec2 way =
          landmarks_px[k + 1 < kLandmarksOfFinger ? i + 1 : i] - landmarks_px[k > 0 ? i - 1 : i];
      const float length_px = glm::length(way);
      if (!(length_px > kThinnest_px)) continue;
      const glm::vec2 along = way / length_px, across(-along.y, along.x);
      result[i] += finger.across[k] * across + finger.along[k] * along;
    }
  return result;
}

}  // namespace handcast::renderer
