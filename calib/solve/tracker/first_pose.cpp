// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/first_pose.hpp"

#include <algorithm>
#include <array>
#include <opencv2/calib3d.hpp>
#include <random>

namespace handcast::calib {
namespace {

constexpr double kStep_s = 0.02;
/// With 50 % outliers, 40 of these triples have none.
constexpr int kTriples = 300;
/// Sightings that judge a hypothesis.
constexpr std::size_t kJudges = 500;
/// Triples with a smaller triangle give poses that are off too far.
constexpr double kLeastArea_m2 = 0.0002;
/// Per offset, of those that are returned.
constexpr std::size_t kKept = 20;

/// A sighting with the tracker's position at its time.
struct Pair {
  glm::dvec3 at_m;
  glm::dvec2 px;
};
using Triple = std::array<Pair, 3>;

/// The pairs at a clock offset, evenly chosen over all sightings, in the order of time.
std::vector<Pair> pairs_at(const Observations& o, double offset_s) {
  std::vector<Pair> pairs;
  const double stride =
      std::max(1., static_cast<double>(o.sightings.size()) / static_cast<double>(kJudges));
  // A quarter of the golden ratio keeps the stride from always meeting the same point of the hand.
  constexpr double kShift = 0.1545;
  const auto count =
      static_cast<int>(std::ceil(static_cast<double>(o.sightings.size()) / (stride + kShift)));
  for (int i = 0; i < count; ++i) {
    const auto& s = o.sightings[static_cast<std::size_t>(i * (stride + kShift))];
    if (const auto moving = o.track.at(s.point, s.time_s + offset_s))
      pairs.push_back({moving->at_m, s.px});
  }
  return pairs;
}

double area_m2(const Triple& triple) {
  return glm::length(glm::cross(triple[1].at_m - triple[0].at_m, triple[2].at_m - triple[0].at_m)) /
         2;
}

/// Up to four poses in which the camera sees the triple as it did. Ke and Roumeliotis 2017.
std::vector<TrackerPose> poses_of(const CameraModel& camera, const Triple& triple) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> images;
  for (const auto& [at_m, px] : triple) {
    points.emplace_back(at_m.x, at_m.y, at_m.z);
    images.emplace_back(px.x, px.y);
  }
  const cv::Matx33d matrix(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  std::vector<cv::Mat> turns, shifts;
  try {
    cv::solveP3P(points, images, matrix, cv::noArray(), turns, shifts, cv::SOLVEPNP_AP3P);
  } catch (const cv::Exception&) {
    return {};  // no solution
  }
  std::vector<TrackerPose> poses;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    cv::Matx33d turn;
    cv::Rodrigues(turns[i], turn);
    TrackerPose pose;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) pose.rotation[c][r] = turn(r, c);
    for (int r = 0; r < 3; ++r) pose.translation_m[r] = shifts[i].at<double>(r);
    poses.push_back(pose);
  }
  return poses;
}

/// Gives up when the sum exceeds `limit_px2`.
double sum_of_squares(const CameraModel& camera, const std::vector<Pair>& pairs,
                      const TrackerPose& pose, double limit_px2) {
  double sum = 0;
  for (const auto& [at_m, px] : pairs) {
    const auto at = pose.apply(at_m);
    const auto off = at.z > 0 ? camera.project(at) - px : glm::dvec2(kNear_px);
    sum += std::min(glm::dot(off, off), kNear_px * kNear_px);
    if (!(sum < limit_px2)) break;
  }
  return sum;
}

/// The best hypotheses at one clock offset.
void search(const CameraModel& camera, const std::vector<Pair>& pairs, double offset_s,
            std::vector<Hypothesis>& found) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, pairs.size() - 1);
  const double all = static_cast<double>(pairs.size());
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < kTriples; ++i) {
    const Triple triple{pairs[any(random)], pairs[any(random)], pairs[any(random)]};
    if (area_m2(triple) < kLeastArea_m2) continue;
    for (auto& pose : poses_of(camera, triple)) {
      pose.offset_s = offset_s;
      const double most_px2 = all * kNear_px * kNear_px;
      const double sum_px2 = sum_of_squares(camera, pairs, pose, most_px2);
      if (sum_px2 < most_px2) hypotheses.push_back({pose, sum_px2 / all});
    }
  }
  const auto kept = std::min(kKept, hypotheses.size());
  std::ranges::partial_sort(hypotheses, hypotheses.begin() + static_cast<std::ptrdiff_t>(kept), {},
                            &Hypothesis::cost_px2);
  found.insert(found.end(), hypotheses.begin(),
               hypotheses.begin() + static_cast<std::ptrdiff_t>(kept));
}

}  // namespace

std::vector<Hypothesis> first_poses(const Observations& o) {
  std::vector<Hypothesis> found;
  const int steps = static_cast<int>(std::lround(kSearch_s / kStep_s));
  for (int i = -steps; i <= steps; ++i) {
    const auto pairs = pairs_at(o, i * kStep_s);
    if (pairs.size() >= 3) search(o.camera, pairs, i * kStep_s, found);
  }
  std::ranges::stable_sort(found, {}, &Hypothesis::cost_px2);
  return found;
}

}  // namespace handcast::calib
