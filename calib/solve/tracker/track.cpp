// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/track.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr double kWindow_s = 0.040;
constexpr double kShortestGap_s = 0.060;

double median_step(const std::vector<double>& times_s) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < times_s.size(); ++i) steps_s.push_back(times_s[i] - times_s[i - 1]);
  return median(std::move(steps_s));
}

}  // namespace

Track::Track(std::vector<double> times_s, const std::vector<std::vector<glm::dvec3>>& points_m)
    : times_s_(std::move(times_s)),
      longest_gap_s_(std::max(kShortestGap_s, 3 * median_step(times_s_))) {
  nodes_.reserve(times_s_.size());
  for (std::size_t i = 0; i < times_s_.size(); ++i) nodes_.push_back(smoothed(i, points_m));
}

std::vector<Moving> Track::smoothed(std::size_t sample,
                                    const std::vector<std::vector<glm::dvec3>>& points_m) const {
  const double now_s = times_s_[sample];
  // With fewer than three samples in the window, the neighbours take their place.
  std::size_t first = sample, last = sample;
  while (first > 0 && now_s - times_s_[first - 1] < kWindow_s) --first;
  while (last + 1 < times_s_.size() && times_s_[last + 1] - now_s < kWindow_s) ++last;
  if (last - first < 2 && first > 0 && now_s - times_s_[first - 1] <= longest_gap_s_) --first;
  if (last - first < 2 && last + 1 < times_s_.size() &&
      times_s_[last + 1] - now_s <= longest_gap_s_)
    ++last;

  const double count = static_cast<double>(last - first + 1);
  glm::dmat3 normal(0);  // of the polynomial in windows of time
  for (std::size_t j = first; j <= last; ++j) {
    const double t = (times_s_[j] - now_s) / kWindow_s;
    const glm::dvec3 powers(1, t, count > 2 ? t * t : 0);
    normal += glm::outerProduct(powers, powers);
  }
  if (count <= 2) normal[2][2] = 1;
  if (count <= 1) normal[1][1] = 1;
  const auto inverse = glm::inverse(normal);
  std::vector<Moving> nodes(points_m[sample].size());
  for (std::size_t j = first; j <= last; ++j) {
    const double t = (times_s_[j] - now_s) / kWindow_s;
    const auto weights = inverse * glm::dvec3(1, t, count > 2 ? t * t : 0);
    for (std::size_t p = 0; p < nodes.size(); ++p) {
      nodes[p].at_m += weights.x * points_m[j][p];
      nodes[p].velocity_m_s += weights.y / kWindow_s * points_m[j][p];
    }
  }
  return nodes;
}

std::optional<Track> Track::mirrored_hand() const {
  constexpr std::size_t kIndexKnuckle = 5, kMiddleKnuckle = 9, kLittleKnuckle = 17;
  if (points() != 21) return std::nullopt;
  auto mirrored = *this;
  for (auto& hand : mirrored.nodes_) {
    const auto middle = hand[kMiddleKnuckle];
    const auto across = glm::normalize(hand[kIndexKnuckle].at_m - hand[kLittleKnuckle].at_m);
    for (auto& point : hand) {
      point.at_m -= 2 * glm::dot(point.at_m - middle.at_m, across) * across;
      point.velocity_m_s -= 2 * glm::dot(point.velocity_m_s - middle.velocity_m_s, across) * across;
    }
  }
  return mirrored;
}

std::optional<Moving> Track::at(int point, double time_s) const {
  const auto next = std::ranges::upper_bound(times_s_, time_s);
  if (next == times_s_.begin() || next == times_s_.end()) return std::nullopt;
  const auto k = static_cast<std::size_t>(next - times_s_.begin());
  const double step_s = times_s_[k] - times_s_[k - 1];
  if (step_s > longest_gap_s_) return std::nullopt;
  const Moving &a = nodes_[k - 1][static_cast<std::size_t>(point)],
               &b = nodes_[k][static_cast<std::size_t>(point)];
  const double u = (time_s - times_s_[k - 1]) / step_s, v = 1 - u;
  const auto rise = b.at_m - a.at_m;
  Moving moving;
  moving.at_m = a.at_m + u * u * (3 - 2 * u) * rise +
                u * v * step_s * (v * a.velocity_m_s - u * b.velocity_m_s);
  moving.velocity_m_s = 6 * u * v / step_s * rise + v * (1 - 3 * u) * a.velocity_m_s +
                        u * (3 * u - 2) * b.velocity_m_s;
  return moving;
}

}  // namespace handcast::calib
