// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/similarity.hpp"
#include "renderer/correct/deform.hpp"

namespace handcast::renderer {
namespace {

/// The motion of a bone, and its weight against moving least squares (0..1).
struct BoneMove : Similarity {
  float trust = 1;
};

/// The bone between landmarks that moves the skin of each joint. Bone 4 f + k of finger f ends at
/// landmark 4 f + k + 1; bones with k = 0 start at the wrist and belong to the palm. The skin of
/// the joints wrist and palm moves with the whole palm, kPalm.
constexpr int kPalm = 20;
constexpr std::array<int, kJoints> kBoneOfJoint{kPalm, kPalm, 1,  2,  3,  3,  4,  5,  6,
                                                7,     7,     8,  9,  10, 11, 11, 12, 13,
                                                14,    15,    15, 16, 17, 18, 19, 19};
constexpr std::array<int, 4> kKnuckles{5, 9, 13, 17};

/// The weight of a bone that is seen `length_px` long: 0 if it is foreshortened, 1 if not.
float trust_in(const config::Correct& settings, float length_px) {
  const auto from = static_cast<float>(settings.bone_short_px),
             to = static_cast<float>(settings.bone_long_px);
  if (to <= from) return length_px >= to ? 1.0f : 0.0f;
  return glm::smoothstep(from, to, length_px);
}

using Landmarks2d = std::span<const glm::vec2, kLandmarks>;

BoneMove finger_bone(const config::Correct& settings, int bone, Landmarks2d p, Landmarks2d q) {
  const int end = bone + 1, start = bone % 4 == 0 ? 0 : bone;
  BoneMove move{fit_similarity(std::array{p[start], p[end]}, std::array{q[start], q[end]})};
  move.trust = trust_in(settings, glm::distance(p[start], p[end]));
  return move;
}

/// The bone from the wrist to the middle of the knuckles. It is exact at the wrist.
BoneMove palm_bone(const config::Correct& settings, Landmarks2d p, Landmarks2d q) {
  glm::vec2 p_knuckles{0}, q_knuckles{0};
  float longest_px = 0;
  for (const int knuckle : kKnuckles) {
    p_knuckles += p[knuckle] / static_cast<float>(kKnuckles.size());
    q_knuckles += q[knuckle] / static_cast<float>(kKnuckles.size());
    longest_px = std::max(longest_px, glm::distance(p[knuckle], p[0]));
  }
  BoneMove move{fit_similarity(std::array{p[0], p_knuckles}, std::array{q[0], q_knuckles})};
  move.trust = trust_in(settings, longest_px);
  return move;
}

/// Cosine, sine, shift x and shift y in one register.
using Four = float __attribute__((vector_size(16)));

/// The moves of the joints, multiplied by their trust: a weighted sum of them is a sum of numbers.
struct JointMoves {
  std::array<Four, kJoints> move;
  std::array<float, kJoints> trust;
  bool all_trusted = true;
};

JointMoves joint_moves(const config::Correct& settings, Landmarks2d p, Landmarks2d q) {
  std::array<BoneMove, kPalm + 1> bones;
  for (int bone = 0; bone < kPalm; ++bone) bones[bone] = finger_bone(settings, bone, p, q);
  bones[kPalm] = palm_bone(settings, p, q);
  JointMoves moves;
  for (int j = 0; j < kJoints; ++j) {
    const BoneMove& bone = bones[kBoneOfJoint[j]];
    moves.move[j] = bone.trust * Four{bone.cosine, bone.sine, bone.shift.x, bone.shift.y};
    moves.trust[j] = bone.trust;
    moves.all_trusted &= bone.trust >= 1;
  }
  return moves;
}

/// Moves every vertex by its bones, weighted by their trust. If the weights sum to less than 1, the
/// result is that share of a position, and the rest must be added.
void move_by_bones(const HandMesh& hand, const JointMoves& moves, std::span<glm::vec2> vertices,
                   std::size_t first, std::size_t end) {
  for (std::size_t v = first; v < end; ++v) {
    const auto& joints = hand.joints[v];
    const auto& weights = hand.weights[v];
    const Four sum = weights[0] * moves.move[joints[0]] + weights[1] * moves.move[joints[1]] +
                     weights[2] * moves.move[joints[2]] + weights[3] * moves.move[joints[3]];
    const glm::vec2 at = vertices[v];
    vertices[v] = {sum[0] * at.x - sum[1] * at.y + sum[2], sum[1] * at.x + sum[0] * at.y + sum[3]};
  }
}

constexpr std::size_t kBatch = 256;  ///< vertices that are corrected at once

/// The vertices of a batch whose bones have a total weight below 1, and the share that remains.
struct LeftOver {
  std::size_t count = 0;
  std::array<std::uint16_t, kBatch> vertex;
  std::array<float, kBatch> share;
  std::array<glm::vec2, kBatch> place;
};

void find_left_over(const HandMesh& hand, const JointMoves& moves,
                    std::span<const glm::vec2> vertices, std::size_t first, std::size_t end,
                    LeftOver& left) {
  constexpr float kNothing = 1e-3f;
  left.count = 0;
  if (moves.all_trusted) return;
  for (std::size_t v = first; v < end; ++v) {
    float share = 1;
    for (int k = 0; k < 4; ++k) share -= hand.weights[v][k] * moves.trust[hand.joints[v][k]];
    if (share < kNothing) continue;
    left.vertex[left.count] = static_cast<std::uint16_t>(v);
    left.share[left.count] = share;
    left.place[left.count++] = vertices[v];
  }
}

}  // namespace

void correct_vertices(const config::Correct& settings, const HandMesh& hand, Landmarks2d p,
                      Landmarks2d q, std::span<glm::vec2> vertices) {
  const JointMoves moves = joint_moves(settings, p, q);
  const MovingLeastSquares field(p, q, static_cast<float>(settings.alpha));
  LeftOver left;
  for (std::size_t first = 0; first < vertices.size(); first += kBatch) {
    const std::size_t end = std::min(first + kBatch, vertices.size());
    find_left_over(hand, moves, vertices, first, end, left);
    move_by_bones(hand, moves, vertices, first, end);
    field.apply(std::span(left.place).first(left.count));
    for (std::size_t k = 0; k < left.count; ++k)
      vertices[left.vertex[k]] += left.share[k] * left.place[k];
  }
}

}  // namespace handcast::renderer
