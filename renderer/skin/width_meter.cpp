// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/width_meter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

/// Landmarks at which the middle phalanges start. Proximal phalanges touch; distal ones taper.
constexpr std::array<int, 5> kBones{2, 6, 10, 14, 18};
/// The part of a bone whose edges are kept: enough for the middle of a stretched bone.
constexpr float kFrom = 0.15f, kTo = 0.85f;
constexpr float kLeastWeight = 0.5f;  ///< of a bone in its vertices
constexpr std::size_t kFewestEdges = 20;
constexpr float kThinnest_px = 4;  ///< bones smaller than this are not measured
/// Length / width as modelled; shorter bones are seen from the end.
constexpr float kShortest = 1.3f;
constexpr float kFastest_px_s = 400;  ///< faster hands are blurred and their masks lag
constexpr float kLeast = 0.75f, kMost = 1.35f;
constexpr int kMemory = 600, kEnough = 12;  ///< measurements of one bone
constexpr std::size_t kFewestBones = 3;
/// Limits of the factor. What is drawn too wide is cut off by the mask; what is drawn too thin must
/// be filled, so fingers are hardly made thinner.
constexpr float kThinnest = 0.93f, kThickest = 1.2f;
constexpr float kStep = 0.005f;  ///< largest change of the factor per frame, so it does not jump
constexpr std::int64_t kForget_ns = 1'000'000'000;

/// The distance from `start` in direction `way` (unit) to the end of the mask. Empty if it does not
/// end within `most_px`.
std::optional<float> reach_px(GreyView mask, glm::vec2 start, glm::vec2 way, float most_px) {
  constexpr float kStride_px = 0.5f;
  for (int step = 0; static_cast<float>(step) * kStride_px < most_px; ++step) {
    const glm::vec2 place = start + way * (static_cast<float>(step) * kStride_px);
    const bool seen = place.x > 0 && place.y > 0 && place.x < static_cast<float>(mask.width - 1) &&
                      place.y < static_cast<float>(mask.height - 1);
    if (!seen) return std::nullopt;
    const glm::ivec2 at(glm::round(place));
    if (mask.at(at.x, at.y) < 128) return (static_cast<float>(step) - 0.5f) * kStride_px;
  }
  return std::nullopt;
}

float weight_of(const HandMesh& mesh, std::size_t vertex, int joint) {
  float weight = 0;
  for (int k = 0; k < 4; ++k)
    if (mesh.joints[vertex][k] == joint) weight += mesh.weights[vertex][k];
  return weight;
}

/// The edges around the middle of a bone, whose ends are moved by it.
std::vector<std::array<std::uint16_t, 2>> edges_around(const HandMesh& mesh, int landmark) {
  const int joint = msg::kJointOfLandmark[landmark], next = msg::kJointOfLandmark[landmark + 1];
  const glm::vec3 start(mesh.rest[joint][3]), way = glm::vec3(mesh.rest[next][3]) - start;
  std::vector<bool> around(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const float along = glm::dot(mesh.positions[v] - start, way) / glm::dot(way, way);
    around[v] = along > kFrom && along < kTo && weight_of(mesh, v, joint) > kLeastWeight;
  }
  std::vector<std::array<std::uint16_t, 2>> edges;
  for (const auto& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint16_t a = triangle[corner], b = triangle[(corner + 1) % 3];
      if (a < b && around[a] && around[b])
        edges.push_back({a, b});  // a < b: the other triangle of this edge has (b, a)
    }
  return edges;
}

}  // namespace

WidthMeter::WidthMeter(const HandMesh& mesh) {
  for (const int landmark : kBones) {
    Bone bone{landmark, edges_around(mesh, landmark)};
    if (bone.edges.size() >= kFewestEdges) bones_.push_back(std::move(bone));
  }
}

void WidthMeter::measure(std::int64_t time_ns, std::span<const glm::vec2> projected_px,
                         const LandmarkPoints& landmarks_px, GreyView mask) {
  const std::int64_t step_ns = time_ns - last_ns_;
  if (step_ns > kForget_ns) forget();
  const float still_px = kFastest_px_s * static_cast<float>(ns_to_seconds(step_ns));
  for (Bone& bone : bones_) {
    if (glm::distance(landmarks_px[bone.landmark], last_px_[bone.landmark]) > still_px) continue;
    if (const auto ratio = ratio_at(bone, projected_px, landmarks_px, mask))
      bone.note(factor_ * *ratio);
  }
  last_ns_ = time_ns;
  last_px_ = landmarks_px;
  if (const auto factor = typical()) factor_ += std::clamp(*factor - factor_, -kStep, kStep);
}

std::optional<float> WidthMeter::ratio_at(const Bone& bone, std::span<const glm::vec2> projected_px,
                                          const LandmarkPoints& landmarks_px, GreyView mask) const {
  const glm::vec2 start = landmarks_px[bone.landmark], end = landmarks_px[bone.landmark + 1];
  const float length_px = glm::distance(start, end);
  if (!(length_px > kThinnest_px)) return std::nullopt;
  const glm::vec2 along = (end - start) / length_px, across(-along.y, along.x),
                  middle = 0.5f * (start + end);
  float low = 0, high = 0;
  for (const auto& [a, b] : bone.edges) {
    const glm::vec2 from = projected_px[a] - middle, to = projected_px[b] - middle;
    const float before = glm::dot(from, along), behind = glm::dot(to, along);
    if (before * behind > 0 || before == behind) continue;
    const float side = glm::dot(glm::mix(from, to, before / (before - behind)), across);
    low = std::min(low, side);
    high = std::max(high, side);
  }
  const float drawn_px = high - low;
  if (!(drawn_px > kThinnest_px) || length_px * factor_ < kShortest * drawn_px) return std::nullopt;
  const auto left_px = reach_px(mask, middle, across, drawn_px),
             right_px = reach_px(mask, middle, -across, drawn_px);
  if (!left_px || !right_px) return std::nullopt;
  const float ratio = (*left_px + *right_px) / drawn_px;
  return ratio > kLeast && ratio < kMost ? std::optional(ratio) : std::nullopt;
}

void WidthMeter::forget() {
  for (Bone& bone : bones_) {
    bone.seen = {};
    bone.count = 0;
  }
}

/// The median of the bones that were measured often enough, within the limits. Empty if the bones
/// are too few to outvote a wrong one.
std::optional<float> WidthMeter::typical() const {
  std::array<float, kBones.size()> medians;
  std::size_t count = 0;
  for (const Bone& bone : bones_)
    if (bone.count >= kEnough) medians[count++] = bone.median();
  if (count < kFewestBones) return std::nullopt;
  const auto middle = medians.begin() + count / 2;
  std::nth_element(medians.begin(), middle, medians.begin() + count);
  return std::clamp(*middle, kThinnest, kThickest);
}

void WidthMeter::Bone::note(float factor) {
  const float place = (std::clamp(factor, kLeast, kMost) - kLeast) / (kMost - kLeast);
  ++seen[static_cast<std::size_t>(std::lround(place * static_cast<float>(seen.size() - 1)))];
  if (++count < kMemory) return;
  count = 0;
  for (int& bin : seen) count += bin /= 2;
}

float WidthMeter::Bone::median() const {
  std::size_t bin = 0;
  for (int below = seen[0]; 2 * below < count && bin + 1 < seen.size(); below += seen[bin]) ++bin;
  return kLeast + (kMost - kLeast) * static_cast<float>(bin) / static_cast<float>(seen.size() - 1);
}

}  // namespace handcast::renderer
