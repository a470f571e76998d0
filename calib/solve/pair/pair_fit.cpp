// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/solve/lens/select.hpp"
#include "calib/solve/pair/pair_error.hpp"
#include "calib/solve/pair/pair_spread.hpp"

namespace handcast::calib {
namespace {

constexpr double kMostRejected = 0.3;  ///< the share of the views that may contradict the others
constexpr double kHarmless_px = 0.25;  ///< so little is no contradiction
constexpr double kNonsense_px = 5;     ///< no still board is so far from where it is expected

/// The views that take part, their places in the caller's list, and why the others do not.
struct Chosen {
  std::vector<PairPoints> views;
  std::vector<std::size_t> places;
  std::vector<std::string> reasons;  ///< of all views; empty: takes part
};

Chosen choose(std::span<const PairView> views) {
  Chosen chosen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto first = select(std::array{views[i].first}),
               second = select(std::array{views[i].second});
    std::string reason;
    if (first.views.empty())
      reason = "In the first image: " + first.reasons.front();
    else if (second.views.empty())
      reason = "In the second image: " + second.reasons.front();
    if (reason.empty()) {
      chosen.views.push_back({first.views.front(), second.views.front()});
      chosen.places.push_back(i);
    }
    chosen.reasons.push_back(std::move(reason));
  }
  return chosen;
}

void reject(Chosen& chosen, std::size_t i, std::string reason) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  chosen.reasons[chosen.places[i]] = std::move(reason);
  chosen.views.erase(chosen.views.begin() + at);
  chosen.places.erase(chosen.places.begin() + at);
}

Result<void> check_enough(const Chosen& chosen) {
  if (chosen.views.size() >= kFewestViews) return {};
  return fail(Errc::bad_data,
              fmt::format("The second camera's place cannot be determined from {} views of the "
                          "board; hold it still where both cameras see it, at least at {} places, "
                          "better 15.",
                          chosen.views.size(), kFewestViews));
}

/// Solves without the views that contradict the others. The worst view goes first: it may be what
/// makes the others look bad.
Result<PairSolution> solve_robustly(Chosen& chosen, const Cameras& cameras) {
  const auto before = chosen.views.size();
  for (;;) {
    if (auto enough = check_enough(chosen); !enough) return tl::make_unexpected(enough.error());
    const auto guess = first_guess(chosen.views, cameras);
    const auto solution = guess ? solve(chosen.views, cameras, *guess) : std::nullopt;
    if (!solution)
      return fail(Errc::bad_data, "The views do not determine the second camera's place.");
    const double limit = limit_px(solution->rms_px);
    const auto worst = std::ranges::max_element(solution->rms_px);
    if (*worst <= std::clamp(limit, kHarmless_px, kNonsense_px)) return *solution;
    const auto rejected = before - chosen.views.size() + 1;
    if (static_cast<double>(rejected) > kMostRejected * static_cast<double>(before))
      return fail(Errc::bad_data,
                  "The views contradict each other: did a camera move, is one lens that of the "
                  "other camera, or was the board not still?");
    reject(
        chosen, static_cast<std::size_t>(worst - solution->rms_px.begin()),
        fmt::format("Its error of {:.2f} px is far above the usual one; the board was not still, "
                    "or its images are of different times.",
                    *worst));
  }
}

glm::dvec3 middle_of_m(const Chosen& chosen, const PairSolution& solution) {
  glm::dvec3 sum_m(0);
  double corners = 0;
  for (std::size_t i = 0; i < chosen.views.size(); ++i) {
    const auto first_from_board = matrix_of(solution.boards[i]);
    for (const auto& m : chosen.views[i].first.board_m) {
      sum_m += glm::dvec3(first_from_board * glm::dvec4(m.x, m.y, m.z, 1));
      ++corners;
    }
  }
  return sum_m / corners;
}

/// Sets views and rms_px.
void describe_views(const Chosen& chosen, const PairSolution& solution, PairFit& fit) {
  for (const auto& reason : chosen.reasons) fit.views.push_back({0, reason});
  double squares = 0, corners = 0;
  for (std::size_t i = 0; i < chosen.views.size(); ++i) {
    const auto& [first, second] = chosen.views[i];
    const auto count = static_cast<double>(first.image_px.size() + second.image_px.size());
    fit.views[chosen.places[i]].rms_px = solution.rms_px[i];
    squares += solution.rms_px[i] * solution.rms_px[i] * count;
    corners += count;
  }
  fit.rms_px = std::sqrt(squares / corners);
}

}  // namespace

Result<PairFit> fit_pair(std::span<const PairView> views, const KnownLenses& lenses) {
  const Cameras cameras{lenses[0].camera, lenses[1].camera};
  auto chosen = choose(views);
  const auto solution = solve_robustly(chosen, cameras);
  if (!solution) return tl::make_unexpected(solution.error());
  const auto error = held_out(chosen.views, cameras, *solution);
  if (!error)
    return fail(Errc::bad_data,
                "The cameras never saw the same corners of the board; hold it where both see all "
                "of it.");
  const auto poses = resample(chosen.views, lenses, *solution);
  if (poses.empty())
    return fail(Errc::bad_data, "The views do not determine the second camera's place.");
  PairFit fit;
  fit.second_from_first = matrix_of(solution->pair);
  fit.held_out_px = error->epipolar_px;
  fit.held_out_mm = error->place_mm;
  fit.middle_m = middle_of_m(chosen, *solution);
  describe_views(chosen, *solution, fit);
  describe_spread(poses, chosen.views.size(), fit);
  return fit;
}

}  // namespace handcast::calib
