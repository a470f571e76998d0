// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/select.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/solve/lens/coverage.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr std::size_t kFewestCorners = 6;
/// A corner farther from where the board's homography has it is a mistake, in squares.
constexpr double kMistake = 0.5;
/// A view is left out if its error exceeds the median by so many robust standard deviations, and by
/// this factor: with few views the deviation itself is uncertain.
/// @{
constexpr double kOutlier = 3, kOutlierFactor = 1.5;
/// @}
/// The share of the views that may contradict the others.
constexpr double kMostRejected = 0.3;

bool is_finite(const BoardView& view) {
  return view.ids.size() == view.image_px.size() && view.ids.size() == view.board_m.size() &&
         std::ranges::all_of(view.image_px,
                             [](auto px) { return std::isfinite(px.x) && std::isfinite(px.y); }) &&
         std::ranges::all_of(view.board_m, [](auto m) { return std::isfinite(m.x + m.y + m.z); });
}

std::string fault_of(const BoardView& view) {
  if (!is_finite(view)) return "The view has corners that are not numbers.";
  if (view.ids.size() < kFewestCorners)
    return fmt::format("The view has {} corners; at least {} are needed.", view.ids.size(),
                       kFewestCorners);
  if (mistake_of(view) > kMistake)
    return "The corners do not lie on a flat board; some were mistaken for others.";
  return {};
}

void reject(Selection& selection, std::size_t i, std::string reason) {
  selection.reasons[selection.places[i]] = std::move(reason);
  selection.views.erase(selection.views.begin() + static_cast<std::ptrdiff_t>(i));
  selection.places.erase(selection.places.begin() + static_cast<std::ptrdiff_t>(i));
}

}  // namespace

double limit_px(const std::vector<double>& rms_px) {
  const double middle_px = median(rms_px);
  auto off_px = rms_px;
  for (double& px : off_px) px = std::abs(px - middle_px);
  return std::max(middle_px + kOutlier * kSigmaPerMad * median(off_px), kOutlierFactor * middle_px);
}

tl::unexpected<Error> too_few(std::size_t views) {
  return fail(Errc::bad_data,
              fmt::format("The lens cannot be determined from {} views of the board; take at least "
                          "{}, better 15, with the board in all parts of the image.",
                          views, kFewestViews));
}

tl::unexpected<Error> not_tilted(std::string_view why) {
  return fail(Errc::bad_data,
              fmt::format("The focal length cannot be determined, {}; tilt the board by 20 to 40 "
                          "degrees to the left, to the right, up and down.",
                          why));
}

Selection select(std::span<const BoardView> views) {
  Selection selection;
  for (std::size_t i = 0; i < views.size(); ++i) {
    selection.reasons.push_back(fault_of(views[i]));
    if (!selection.reasons.back().empty()) continue;
    selection.views.push_back(points_of(views[i]));
    selection.places.push_back(i);
  }
  return selection;
}

/// The worst view goes first: it may be what makes the others look bad.
Result<Solution> solve_robustly(Selection& selection, int width_px, int height_px) {
  const auto before = selection.views.size();
  for (;;) {
    if (selection.views.size() < kFewestViews) return too_few(selection.views.size());
    const auto guess = first_guess(selection.views, width_px, height_px);
    const auto solution = guess ? solve(selection.views, Distortion::k3, *guess) : std::nullopt;
    if (!solution) return not_tilted("since the views do not differ enough");
    const double limit = limit_px(solution->rms_px);
    const auto worst = std::ranges::max_element(solution->rms_px);
    if (*worst <= limit) return *solution;
    const auto rejected = before - selection.views.size() + 1;
    if (static_cast<double>(rejected) > kMostRejected * static_cast<double>(before))
      return fail(Errc::bad_data,
                  "The views contradict each other; keep the board flat and still, and check the "
                  "size of its squares.");
    reject(selection, static_cast<std::size_t>(worst - solution->rms_px.begin()),
           fmt::format("Its error of {:.2f} px is far above the {:.2f} px of the usual "
                       "view.",
                       *worst, median(solution->rms_px)));
  }
}

}  // namespace handcast::calib
