// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/match.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr double kSmallest_px = 6;
/// Bones have other forms than the model's, and the landmarks of a detector other places: a share
/// of the hand's extent, about 1.5 mm.
constexpr double kModelShare = 0.025;

}  // namespace

double extent_px(const std::array<glm::dvec2, msg::kLandmarks>& px) {
  glm::dvec2 mean(0);
  for (const auto& point : px) mean += point / static_cast<double>(msg::kLandmarks);
  double squares = 0;
  for (const auto& point : px) squares += glm::dot(point - mean, point - mean);
  return std::sqrt(squares / msg::kLandmarks);
}

std::optional<SeenHand> read(const msg::HandLandmarks& landmarks) {
  SeenHand hand;
  int count = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& point = landmarks.points[i];
    if (!std::isfinite(point.x_px) || !std::isfinite(point.y_px) ||
        !std::isfinite(point.sigma_px) || !std::isfinite(point.confidence))
      return std::nullopt;
    hand.px[i] = {point.x_px, point.y_px};
    count += point.confidence > 0 ? 1 : 0;
  }
  const double extent = extent_px(hand.px);
  if (count < kFewestSeen || !(extent > kSmallest_px) || !(extent < 1e5)) return std::nullopt;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& point = landmarks.points[i];
    if (!(point.confidence > 0)) continue;
    const double sigma_px = std::clamp<double>(point.sigma_px, 0, extent);
    hand.sigma_px[i] =
        std::hypot(sigma_px, kModelShare * extent) / std::clamp<double>(point.confidence, 0.2, 1);
  }
  return hand;
}

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kMostMisfit = 9;    ///< of one landmark, sigmas squared
constexpr double kPalmSizeSd = 0.3;  ///< of the logarithm of the palm's size
constexpr double kMostSizeCost = 16;
/// The costs of a report that is left out, of a hand in one view alone, and of a side that the
/// detector contradicts: for a hand that is not followed, and for one that is.
constexpr double kLeftOut = 8, kAlone = 4, kOtherSide = 1.5, kOtherSideFollowed = 0.3;
/// The cost of a hand that begins, so that a followed one keeps its side for a moment.
constexpr double kBegins = 2;
/// The cost of a hand that is as far from where it is expected as it is large; grows with the
/// square.
constexpr double kElsewhere = 6, kMostElsewhere = 20;

/// Pairs of landmarks in a palm whose distance tells its size.
constexpr std::array<std::array<int, 2>, 5> kPalmSpans{{{0, 5}, {0, 9}, {0, 17}, {5, 17}, {1, 9}}};

/// The logarithm of the palm's size relative to the model's.
double log_size_of(const Skeleton& skeleton,
                   const std::array<std::optional<SpacePoint>, msg::kLandmarks>& points) {
  double seen_m = 0, model_m = 0;
  for (const auto& [a, b] : kPalmSpans) {
    if (!points[a] || !points[b]) continue;
    seen_m += glm::distance(points[a]->place_m, points[b]->place_m);
    model_m += glm::distance(skeleton.at_rest_m(msg::kJointOfLandmark[a]),
                             skeleton.at_rest_m(msg::kJointOfLandmark[b]));
  }
  return model_m > 0 ? std::log(std::max(seen_m, 1e-6) / model_m) : 0;
}

double cost_of_place(const Points& expected, const SeenHand& seen) {
  double sum_px = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) sum_px += glm::distance(expected[i], seen.px[i]);
  const double off = sum_px / msg::kLandmarks / std::max(extent_px(expected), 1.0);
  return std::min(kElsewhere * off * off, kMostElsewhere);
}

/// The choice of one report (or none) of each view for each side, and its cost.
class Choice {
 public:
  Choice(const Skeleton& skeleton, const Views& views, const Reports& reports,
         const std::array<Expected, msg::kMaxHands>& expected)
      : reports_(reports), expected_(expected) {
    for (std::size_t i = 0; i < reports[0].size(); ++i)
      for (std::size_t j = 0; j < reports[1].size(); ++j)
        misfit_[i][j] = misfit_of(skeleton, views, reports[0][i].seen, reports[1][j].seen);
  }

  Matches best() {
    Matches matches{{{-1, -1}, {-1, -1}}};
    double least = kNever;
    const int first = static_cast<int>(reports_[0].size()),
              second = static_cast<int>(reports_[1].size());
    for (int a = -1; a < first; ++a)
      for (int b = -1; b < second; ++b)
        for (int c = -1; c < first; ++c)
          for (int d = -1; d < second; ++d) {
            if ((a >= 0 && a == c) || (b >= 0 && b == d)) continue;
            const Matches these{{{a, b}, {c, d}}};
            const double cost = cost_of(these);
            if (cost < least) least = cost, matches = these;
          }
    return matches;
  }

 private:
  double cost_of(const Matches& these) const {
    double cost = 0;
    std::size_t used = 0;
    for (int side = 0; side < msg::kMaxHands; ++side) {
      const auto& [i, j] = these[side];
      if (i >= 0 && j >= 0) cost += misfit_[i][j];
      if ((i >= 0) != (j >= 0)) cost += kAlone;
      if ((i >= 0 || j >= 0) && !expected_[side]) cost += kBegins;
      for (int v = 0; v < kViews; ++v)
        if (these[side][v] >= 0) {
          cost += cost_of(side, v, reports_[v][these[side][v]]);
          ++used;
        }
    }
    return cost + kLeftOut * static_cast<double>(reports_[0].size() + reports_[1].size() - used);
  }

  double cost_of(int side, int view, const ReportedHand& hand) const {
    const auto& expected = expected_[side];
    const bool is_other = static_cast<int>(hand.side) != side;
    if (!expected) return is_other ? kOtherSide * hand.presence : 0;
    return cost_of_place((*expected)[view], hand.seen) +
           (is_other ? kOtherSideFollowed * hand.presence : 0);
  }

  const Reports& reports_;
  const std::array<Expected, msg::kMaxHands>& expected_;
  std::array<std::array<double, msg::kMaxHands>, msg::kMaxHands> misfit_{};
};

}  // namespace

double misfit_of(const Skeleton& skeleton, const Views& views, const SeenHand& first,
                 const SeenHand& second) {
  std::array<std::optional<SpacePoint>, msg::kLandmarks> points;
  double sum = 0;
  int both = 0, behind = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    if (!(first.sigma_px[i] > 0) || !(second.sigma_px[i] > 0)) continue;
    const std::array sights{Sight{&views[0], first.px[i], first.sigma_px[i]},
                            Sight{&views[1], second.px[i], second.sigma_px[i]}};
    points[i] = triangulate(sights);
    sum += points[i] ? std::min(points[i]->misfit, kMostMisfit) : kMostMisfit;
    ++both;
    behind += points[i] ? 0 : 1;
  }
  if (both < kFewestSeen || 2 * behind > both) return kNever;
  const double off = log_size_of(skeleton, points) / kPalmSizeSd;
  return sum / both + std::min(0.5 * off * off, kMostSizeCost);
}

Matches match(const Skeleton& skeleton, const Views& views, const Reports& reports,
              const std::array<Expected, msg::kMaxHands>& expected) {
  return Choice(skeleton, views, reports, expected).best();
}

}  // namespace handcast::pose::stereo
