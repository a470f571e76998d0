// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/auto_capture.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "calib/solve/lens/coverage.hpp"

namespace handcast::calib {
namespace {

/// A board is still if its corners have moved less than this, on average, for so long.
/// @{
constexpr double kStill_px = 0.5;
constexpr std::int64_t kStill_ns = 300'000'000;
/// @}
/// After a longer gap between two images with a board, nobody knows whether it was still.
constexpr std::int64_t kGap_ns = 1'000'000'000;
/// A view is new if its corners are so far from those of each other view, as a share of the image's
/// width, or if the tangent of its tilt differs by so much.
/// @{
constexpr double kOtherPlace = 0.08;
constexpr double kOtherTilt = 0.2;
/// @}

/// The mean distance between the corners that both views have; infinite if that is less than half
/// of either.
double motion_px(const BoardView& a, const BoardView& b) {
  std::map<int, glm::dvec2> places;
  for (std::size_t i = 0; i < a.ids.size(); ++i) places[a.ids[i]] = a.image_px[i];
  double sum_px = 0;
  std::size_t common = 0;
  for (std::size_t i = 0; i < b.ids.size(); ++i)
    if (const auto place = places.find(b.ids[i]); place != places.end()) {
      sum_px += glm::distance(place->second, b.image_px[i]);
      ++common;
    }
  if (common == 0 || 2 * common < std::max(a.ids.size(), b.ids.size()))
    return std::numeric_limits<double>::infinity();
  return sum_px / static_cast<double>(common);
}

}  // namespace

bool AutoCapture::take_still(const BoardView& view) {
  if (!is_new(view)) return false;
  taken_.push_back({view, tilt_of(view, usual_focal_length_px(width_px_))});
  return true;
}

bool Stillness::see(std::int64_t time_ns, const BoardView& view) {
  const bool gap = time_ns < last_ns_ || time_ns - last_ns_ > kGap_ns;
  last_ns_ = time_ns;
  if (gap || !(motion_px(rest_, view) < kStill_px)) {
    rest_ = view;
    rest_ns_ = time_ns;
    return false;
  }
  return time_ns - rest_ns_ >= kStill_ns;
}

bool AutoCapture::is_new(const BoardView& view) const {
  const auto tilt = tilt_of(view, usual_focal_length_px(width_px_));
  if (!tilt) return false;
  return std::ranges::none_of(taken_, [&](const Taken& taken) {
    return motion_px(taken.view, view) < kOtherPlace * width_px_ && taken.tilt &&
           glm::distance(*taken.tilt, *tilt) < kOtherTilt;
  });
}

}  // namespace handcast::calib
