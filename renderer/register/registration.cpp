// SPDX-License-Identifier: Apache-2.0
#include "renderer/register/registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

namespace handcast::renderer {
namespace {

struct Bone {
  int from, to;
  int finger;  ///< -1: palm
};
constexpr std::array<Bone, 23> kBones{
    {{0, 1, -1},  {0, 5, -1},   {0, 9, -1},  {0, 13, -1}, {0, 17, -1}, {5, 9, -1},
     {9, 13, -1}, {13, 17, -1}, {1, 2, 0},   {2, 3, 0},   {3, 4, 0},   {5, 6, 1},
     {6, 7, 1},   {7, 8, 1},    {9, 10, 2},  {10, 11, 2}, {11, 12, 2}, {13, 14, 3},
     {14, 15, 3}, {15, 16, 3},  {17, 18, 4}, {18, 19, 4}, {19, 20, 4}}};
constexpr std::array<int, 5> kKnuckles{1, 5, 9, 13, 17}, kTips{4, 8, 12, 16, 20};

constexpr float kFurthestSkin_px = 45;  ///< from a bone
constexpr float kTurnLever_px = 60;     ///< the rotation of the hand is in px at this distance
constexpr float kLeastFinger_px = 12;   ///< shorter (foreshortened) fingers move with the palm
constexpr int kLeastPoints = 24;
constexpr float kLeastShare = 0.35f;  ///< of the points, whose edge must be found
constexpr float kGoodFit_px = 1.5f;
constexpr float kNoise_px = 0.1f;  ///< of a median distance
/// Standard deviations of the unknowns, if an edge has a standard deviation of 1 px.
constexpr float kHandPrior_px = 6, kFingerPrior_px = 3;
/// Distances beyond the scale have little weight: kScaleOfMedian medians, but at least
/// kLeastScale_px.
constexpr float kLeastScale_px = 0.8, kScaleOfMedian = 2;

glm::vec2 turned(glm::vec2 v) { return {-v.y, v.x}; }

/// The bones of one hand, prepared for finding the nearest one.
struct Skeleton {
  explicit Skeleton(const LandmarkPoints& joints) {
    for (std::size_t b = 0; b < kBones.size(); ++b) {
      from[b] = joints[kBones[b].from];
      axis[b] = joints[kBones[b].to] - from[b];
      per_length2[b] = 1 / std::max(glm::dot(axis[b], axis[b]), 1e-6f);
    }
  }
  /// Position along bone `b` (0..1) of its point nearest to `at`.
  float along(std::size_t b, glm::vec2 at) const {
    return std::clamp(glm::dot(at - from[b], axis[b]) * per_length2[b], 0.0f, 1.0f);
  }
  /// Squared distance of that point from `at`.
  float distance2(std::size_t b, glm::vec2 at) const {
    const glm::vec2 away = at - from[b] - along(b, at) * axis[b];
    return glm::dot(away, away);
  }
  struct Nearest {
    std::size_t bone = 0;
    float distance2_px2 = kFurthestSkin_px * kFurthestSkin_px;
  };
  Nearest nearest(glm::vec2 at) const {
    Nearest nearest;
    for (std::size_t b = 0; b < kBones.size(); ++b)
      if (const float distance2_px2 = distance2(b, at); distance2_px2 < nearest.distance2_px2)
        nearest = {b, distance2_px2};
    return nearest;
  }

  std::array<glm::vec2, kBones.size()> from, axis;
  std::array<float, kBones.size()> per_length2;
};

/// The rotation of a bone as (cosine, sine); the identity if the bone is too short.
glm::vec2 turn_of(const Bone& bone, const HandMotion& hand) {
  constexpr float kShortest_px = 8;
  const glm::vec2 then = hand.then[bone.to] - hand.then[bone.from],
                  now = hand.now[bone.to] - hand.now[bone.from];
  const float scale = glm::length(then) * glm::length(now);
  if (scale < kShortest_px * kShortest_px) return {1, 0};
  return glm::vec2(glm::dot(then, now), then.x * now.y - then.y * now.x) / scale;
}

glm::vec2 turned_by(glm::vec2 turn, glm::vec2 v) {
  return {turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y};
}

using Solution = Eigen::Matrix<float, 13, 1>;

}  // namespace

void Registration::carry(const Contour& outline, std::span<const HandMotion> hands,
                         std::size_t index) {
  count_ = 0;
  const HandMotion& own = hands[index];
  const Skeleton skeleton(own.then);
  const std::optional<Skeleton> other =
      hands.size() > 1 ? std::optional<Skeleton>(hands[1 - index].then) : std::nullopt;
  std::array<glm::vec2, kBones.size()> turns;
  for (std::size_t b = 0; b < kBones.size(); ++b) turns[b] = turn_of(kBones[b], own);
  for (int i = 0; i < outline.count; ++i) {
    const glm::vec2 at = outline.points_px[i];
    const auto [b, distance2_px2] = skeleton.nearest(at);
    if (distance2_px2 >= kFurthestSkin_px * kFurthestSkin_px ||
        (other && other->nearest(at).distance2_px2 < distance2_px2))
      continue;
    const Bone& bone = kBones[b];
    const float along = skeleton.along(b, at);
    const glm::vec2 then = glm::mix(own.then[bone.from], own.then[bone.to], along);
    const glm::vec2 now = glm::mix(own.now[bone.from], own.now[bone.to], along);
    points_[count_++] = {now + turned_by(turns[b], at - then),
                         turned_by(turns[b], outline.normals[i]),
                         bone.finger,
                         false,
                         0,
                         {}};
  }
}

void Registration::set_rows(const LandmarkPoints& now) {
  centre_ = 0.25f * (now[0] + now[5] + now[9] + now[17]);
  for (int f = 0; f < kFingers; ++f) {
    const glm::vec2 axis = now[kTips[f]] - now[kKnuckles[f]];
    const float length_px = glm::length(axis);
    fingers_[f] = {now[kKnuckles[f]], axis / std::max(length_px, 1e-3f), length_px};
  }
  for (Point& point : std::span(points_).first(count_)) {
    if (point.finger >= 0 && fingers_[point.finger].length_px < kLeastFinger_px) point.finger = -1;
    point.row = {point.normal.x, point.normal.y,
                 glm::dot(point.normal, turned(point.at - centre_)) / kTurnLever_px, 0, 0};
    if (point.finger < 0) continue;
    const Finger& finger = fingers_[point.finger];
    const glm::vec2 out = point.at - finger.knuckle;
    point.row[3] = glm::dot(point.normal, turned(out)) / finger.length_px;
    point.row[4] =
        glm::dot(point.normal, finger.axis) * glm::dot(out, finger.axis) / finger.length_px;
  }
}

glm::vec2 Registration::displacement(glm::vec2 at, int finger) const {
  glm::vec2 moved =
      glm::vec2(solution_[0], solution_[1]) + solution_[2] / kTurnLever_px * turned(at - centre_);
  if (finger < 0) return moved;
  const Finger& own = fingers_[finger];
  const glm::vec2 out = at - own.knuckle;
  const float *unknowns = &solution_[3 + 2 * finger],
              stretched = unknowns[1] * glm::dot(out, own.axis) / own.length_px;
  return moved + unknowns[0] / own.length_px * turned(out) + stretched * own.axis;
}

void Registration::find_edges(const Silhouette& newest, float reach_px) {
  for (Point& point : std::span(points_).first(count_)) {
    const auto edge =
        edge_along(newest, point.at + displacement(point.at, point.finger), point.normal, reach_px);
    point.seen = edge.has_value();
    point.distance_px = edge.value_or(0.0f);
  }
}

/// One robust Gauss-Newton step for the first `unknowns`, with two reweighted solutions. Minimises
/// distance - row x over the points, and x by its prior.
void Registration::step(int unknowns) {
  const float scale_px = std::max(kLeastScale_px, kScaleOfMedian * median_distance());
  Solution change = Solution::Zero();
  for (int again = 0; again < 2; ++again) {
    Eigen::Matrix<float, kUnknowns, kUnknowns> normal =
        Eigen::Matrix<float, kUnknowns, kUnknowns>::Zero();
    Solution right = Solution::Zero();
    for (int i = 0; i < kUnknowns; ++i) {
      const float prior_px = i < 3 ? kHandPrior_px : kFingerPrior_px,
                  weight = i < unknowns ? 1 / (prior_px * prior_px) : 1e6f;
      normal(i, i) = weight;
      right(i) = -weight * solution_[i];
    }
    for (const Point& point : std::span(points_).first(count_)) {
      if (!point.seen) continue;
      std::array<int, 5> at{0, 1, 2, 3 + 2 * point.finger, 4 + 2 * point.finger};
      const int terms = point.finger < 0 ? 3 : 5;
      float left = point.distance_px;
      for (int i = 0; i < terms; ++i) left -= point.row[i] * change(at[i]);
      const float off = left / scale_px, weight = 1 / ((1 + off * off) * (1 + off * off));
      for (int i = 0; i < terms; ++i) {
        right(at[i]) += weight * point.row[i] * point.distance_px;
        for (int k = 0; k < terms; ++k)
          normal(at[i], at[k]) += weight * point.row[i] * point.row[k];
      }
    }
    change = normal.llt().solve(right);
  }
  for (int i = 0; i < kUnknowns; ++i) solution_[i] += change(i);
}

float Registration::median_distance() {
  int seen = 0;
  for (const Point& point : std::span(points_).first(count_))
    if (point.seen) sorted_[seen++] = std::abs(point.distance_px);
  if (seen == 0) return 0;
  std::nth_element(sorted_.begin(), sorted_.begin() + seen / 2, sorted_.begin() + seen);
  return sorted_[seen / 2];
}

Registered Registration::find(const Contour& outline, const Silhouette& newest,
                              std::span<const HandMotion> hands, std::size_t index) {
  const LandmarkPoints& now = hands[index].now;
  Registered result;
  solution_ = {};
  carry(outline, hands, index);
  set_rows(now);
  find_edges(newest, limit_px_);
  result.before_px = median_distance();
  step(3);
  find_edges(newest, limit_px_ / 2);
  step(kUnknowns);
  find_edges(newest, limit_px_ / 4);
  step(kUnknowns);
  find_edges(newest, limit_px_ / 4);
  result.after_px = median_distance();
  for (const Point& point : std::span(points_).first(count_)) result.points += point.seen;

  float furthest_px = 0;
  for (int i = 0; i < kLandmarks; ++i) {
    int finger = finger_of_landmark(i);
    if (finger >= 0 && fingers_[finger].length_px < kLeastFinger_px) finger = -1;
    result.moved[i] = displacement(now[i], finger);
    furthest_px = std::max(furthest_px, glm::length(result.moved[i]));
  }
  result.found = result.points >= kLeastPoints &&
                 static_cast<float>(result.points) > kLeastShare * static_cast<float>(count_) &&
                 result.after_px <= result.before_px + kNoise_px && result.after_px < kGoodFit_px &&
                 furthest_px < limit_px_;
  if (!result.found) result.moved = {};
  return result;
}

}  // namespace handcast::renderer
