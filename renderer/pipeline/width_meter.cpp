#include "renderer/pipeline/width_meter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

constexpr std::array<int, 9> kBones{2, 5, 6, 9, 10, 13, 14, 17, 18};  ///< landmarks where a proximal or middle phalanx begins
constexpr float kFrom = 0.35f, kTo = 0.65f;                           ///< the middle of a bone
constexpr float kLeastWeight = 0.7f;                                  ///< of a bone in a vertex that counts as its own
constexpr std::size_t kFewestVertices = 6;
constexpr float kThinnest_px = 4;     ///< nothing is measured on less
constexpr float kShortest = 0.9f;     ///< of its drawn width: a bone seen shorter is seen from its end
constexpr float kFastest_px_s = 250;  ///< faster hands blur and their masks lag
constexpr float kRim_px = 0.5f;       ///< the mask's edge is this far outside the finger's, on each side
constexpr float kLeast = 0.75f, kMost = 1.35f;
constexpr int kMemory = 4000, kEnough = 60;  ///< bones measured
constexpr float kStep = 0.005f;              ///< of the factor in one frame: the light must not twitch
constexpr std::int64_t kForget_ns = 1'000'000'000;

/// How far the mask reaches from `start` in direction `way` (unit); nothing where it does not end within `most_px`.
std::optional<float> reach_px(GreyView mask, glm::vec2 start, glm::vec2 way, float most_px) {
  constexpr float kStride_px = 0.5f;
  for (float far_px = 0; far_px < most_px; far_px += kStride_px) {
    const glm::ivec2 at(glm::round(start + way * far_px));
    if (at.x < 0 || at.y < 0 || at.x >= mask.width || at.y >= mask.height) return std::nullopt;
    if (mask.at(at.x, at.y) == 0) return far_px - kStride_px / 2;
  }
  return std::nullopt;
}

float weight_of(const HandMesh& mesh, std::size_t vertex, int joint) {
  float weight = 0;
  for (int k = 0; k < 4; ++k)
    if (mesh.joints[vertex][k] == joint) weight += mesh.weights[vertex][k];
  return weight;
}

/// The vertices that hang on a bone and lie around its middle.
std::vector<std::uint16_t> around_middle(const HandMesh& mesh, int landmark) {
  const int joint = msg::kJointOfLandmark[landmark], next = msg::kJointOfLandmark[landmark + 1];
  const glm::vec3 start(mesh.rest[joint][3]), way = glm::vec3(mesh.rest[next][3]) - start;
  std::vector<std::uint16_t> vertices;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const float along = glm::dot(mesh.positions[v] - start, way) / glm::dot(way, way);
    if (along > kFrom && along < kTo && weight_of(mesh, v, joint) > kLeastWeight) vertices.push_back(static_cast<std::uint16_t>(v));
  }
  return vertices;
}

}  // namespace

WidthMeter::WidthMeter(const HandMesh& mesh) {
  for (const int landmark : kBones) {
    Bone bone{landmark, around_middle(mesh, landmark)};
    if (bone.middle.size() >= kFewestVertices) bones_.push_back(std::move(bone));
  }
}

void WidthMeter::measure(std::int64_t time_ns, std::span<const glm::vec2> landings_px, const LandmarkPoints& landmarks_px, GreyView mask) {
  const std::int64_t step_ns = time_ns - last_ns_;
  if (step_ns > kForget_ns) forget();
  const float still_px = kFastest_px_s * static_cast<float>(ns_to_seconds(step_ns));
  for (const Bone& bone : bones_) {
    if (glm::distance(landmarks_px[bone.landmark], last_px_[bone.landmark]) > still_px) continue;
    if (const auto ratio = ratio_at(bone, landings_px, landmarks_px, mask)) note(factor_ * *ratio);
  }
  last_ns_ = time_ns;
  last_px_ = landmarks_px;
  if (count_ >= kEnough) factor_ += std::clamp(median() - factor_, -kStep, kStep);
}

std::optional<float> WidthMeter::ratio_at(const Bone& bone, std::span<const glm::vec2> landings_px, const LandmarkPoints& landmarks_px,
                                          GreyView mask) const {
  const glm::vec2 start = landmarks_px[bone.landmark], end = landmarks_px[bone.landmark + 1];
  const float length_px = glm::distance(start, end);
  if (!(length_px > kThinnest_px)) return std::nullopt;
  const glm::vec2 along = (end - start) / length_px, across(-along.y, along.x), middle = 0.5f * (start + end);
  float low = 0, high = 0;
  for (const std::uint16_t v : bone.middle) {
    const float side = glm::dot(landings_px[v] - middle, across);
    low = std::min(low, side);
    high = std::max(high, side);
  }
  const float drawn_px = high - low;
  if (!(drawn_px > kThinnest_px) || length_px < kShortest * drawn_px) return std::nullopt;
  const auto left_px = reach_px(mask, middle, across, drawn_px), right_px = reach_px(mask, middle, -across, drawn_px);
  if (!left_px || !right_px) return std::nullopt;
  const float ratio = (*left_px + *right_px - 2 * kRim_px) / drawn_px;
  return ratio > kLeast && ratio < kMost ? std::optional(ratio) : std::nullopt;
}

void WidthMeter::forget() {
  seen_ = {};
  count_ = 0;
  factor_ = 1;
}

void WidthMeter::note(float factor) {
  const float place = (std::clamp(factor, kLeast, kMost) - kLeast) / (kMost - kLeast);
  ++seen_[static_cast<std::size_t>(place * (kBins - 1) + 0.5f)];
  if (++count_ < kMemory) return;
  count_ = 0;
  for (int& bin : seen_) count_ += bin /= 2;
}

float WidthMeter::median() const {
  int below = 0, bin = 0;
  while (bin < kBins - 1 && 2 * (below + seen_[static_cast<std::size_t>(bin)]) < count_) below += seen_[static_cast<std::size_t>(bin++)];
  return kLeast + (kMost - kLeast) * static_cast<float>(bin) / (kBins - 1);
}

}  // namespace handcast::renderer
