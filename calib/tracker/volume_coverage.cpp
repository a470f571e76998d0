// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/volume_coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace handcast::calib {

double depth_by_size_m(const CameraModel& camera, std::span<const SeenPoint> hand) {
  constexpr double kLeast_m = 0.04, kLeast_px = 8, kQuantile = 0.2;
  constexpr std::size_t kFewest = 10;
  std::vector<double> depths_m;
  for (std::size_t i = 0; i < hand.size(); ++i)
    for (std::size_t j = i + 1; j < hand.size(); ++j) {
      const double apart_m = glm::distance(hand[i].tracker_m, hand[j].tracker_m);
      const double apart_px = glm::distance(hand[i].undistorted_px, hand[j].undistorted_px);
      if (apart_m >= kLeast_m && apart_px >= kLeast_px)
        depths_m.push_back(camera.fx_px * apart_m / apart_px);
    }
  if (depths_m.size() < kFewest) return 0;
  const auto at = depths_m.begin() +
                  static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(depths_m.size()));
  std::nth_element(depths_m.begin(), at, depths_m.end());
  return *at;
}

VolumeCoverage::VolumeCoverage(const CameraModel& camera, double near_m, double far_m)
    : camera_(camera), near_m_(near_m), far_m_(far_m) {}

void VolumeCoverage::add(std::span<const SeenPoint> hand) {
  const double z = kDepths * (depth_by_size_m(camera_, hand) - near_m_) / (far_m_ - near_m_);
  for (const auto& [px, tracker_m] : hand) {
    const double x = kSide * (px.x + 0.5) / camera_.width_px,
                 y = kSide * (px.y + 0.5) / camera_.height_px;
    if (!(x >= 0 && x < kSide && y >= 0 && y < kSide && z >= 0 && z < kDepths)) continue;
    const int cell =
        (static_cast<int>(z) * kSide + static_cast<int>(y)) * kSide + static_cast<int>(x);
    ++counts_[static_cast<std::size_t>(cell)];
  }
}

double VolumeCoverage::share() const {
  return static_cast<double>(std::ranges::count_if(counts_, [](int n) { return n >= kEnough; })) /
         static_cast<double>(counts_.size());
}

std::string VolumeCoverage::advice() const {
  constexpr std::array<std::string_view, kDepths> kDistances{"near the camera", "halfway",
                                                             "far from the camera"};
  constexpr std::array<std::string_view, kSide> kRows{"top", "middle", "bottom"},
      kColumns{"left", "middle", "right"};
  // The depth with the most empty cells; there, the first empty one.
  int emptiest = 0, most = 0;
  for (int d = 0; d < kDepths; ++d) {
    int empty = 0;
    for (int cell = 0; cell < kSide * kSide; ++cell)
      empty += !covered(d, cell / kSide, cell % kSide);
    if (empty > most) {
      most = empty;
      emptiest = d;
    }
  }
  if (most == 0) return "The volume is covered.";
  const std::string where =
      fmt::format("{} ({:.1f} m)", kDistances[static_cast<std::size_t>(emptiest)],
                  near_m_ + (emptiest + 0.5) * (far_m_ - near_m_) / kDepths);
  if (most == kSide * kSide) return fmt::format("Move the hand {}.", where);
  int cell = 0;
  while (covered(emptiest, cell / kSide, cell % kSide)) ++cell;
  return fmt::format("Move the hand to the {} {} of the image, {}.",
                     kRows[static_cast<std::size_t>(cell / kSide)],
                     kColumns[static_cast<std::size_t>(cell % kSide)], where);
}

}  // namespace handcast::calib
