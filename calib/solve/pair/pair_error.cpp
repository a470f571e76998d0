// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_error.hpp"

#include <cmath>
#include <vector>

#include "calib/solve/pair/corner_error.hpp"

namespace handcast::calib {
namespace {

constexpr int kParts = 5;

struct Sums {
  double px2 = 0, mm2 = 0;
  int corners = 0;
};

void add(const PairPoints& view, const Cameras& cameras, const glm::dmat4& second_from_first,
         Sums& sums) {
  for (const auto& error : corner_errors(view, cameras, second_from_first)) {
    sums.px2 += error.off_line2_px2;
    sums.mm2 += 1e6 * glm::dot(error.off_m, error.off_m);
    ++sums.corners;
  }
}

}  // namespace

std::optional<PairError> held_out(std::span<const PairPoints> views, const Cameras& cameras,
                                  const PairSolution& solution) {
  Sums sums;
  for (std::size_t part = 0; part < kParts; ++part) {
    std::vector<PairPoints> others;
    PairSolution near{solution.pair, {}, {}};
    for (std::size_t i = 0; i < views.size(); ++i)
      if (i % kParts != part) {
        others.push_back(views[i]);
        near.boards.push_back(solution.boards[i]);
      }
    const auto fit = solve(others, cameras, near);
    if (!fit) return {};
    for (auto i = part; i < views.size(); i += kParts)
      add(views[i], cameras, matrix_of(fit->pair), sums);
  }
  if (sums.corners == 0) return {};
  return PairError{std::sqrt(sums.px2 / sums.corners), std::sqrt(sums.mm2 / sums.corners)};
}

}  // namespace handcast::calib
