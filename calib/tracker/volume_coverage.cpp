// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/volume_coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace handcast::calib {

VolumeCoverage::VolumeCoverage(const CameraModel& camera,
                               const glm::dmat4& rough_camera_from_tracker, double near_m,
                               double far_m)
    : camera_(camera), rough_(rough_camera_from_tracker), near_m_(near_m), far_m_(far_m) {}

void VolumeCoverage::add(const glm::dvec2& px, const glm::dvec3& tracker_m) {
  const double depth_m = (rough_ * glm::dvec4(tracker_m, 1)).z;
  const double x = kSide * (px.x + 0.5) / camera_.width_px,
               y = kSide * (px.y + 0.5) / camera_.height_px,
               z = kDepths * (depth_m - near_m_) / (far_m_ - near_m_);
  if (!(x >= 0 && x < kSide && y >= 0 && y < kSide && z >= 0 && z < kDepths)) return;
  const int cell =
      (static_cast<int>(z) * kSide + static_cast<int>(y)) * kSide + static_cast<int>(x);
  ++counts_[static_cast<std::size_t>(cell)];
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
