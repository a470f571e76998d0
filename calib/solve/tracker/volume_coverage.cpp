// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/volume_coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "ipc/base/statistics.hpp"

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
  return quantile(std::move(depths_m), kQuantile);
}

VolumeCoverage::VolumeCoverage(const CameraModel& camera, double near_m, double far_m)
    : camera_(camera),
      near_m_(near_m),
      far_m_(far_m),
      fields_(kDepths, {camera.width_px, camera.height_px}) {}

void VolumeCoverage::add(std::span<const SeenPoint> hand) {
  const double depth_m = depth_by_size_m(camera_, hand);
  for (const auto& point : hand) add(point.undistorted_px, depth_m);
}

void VolumeCoverage::add(const glm::dvec2& undistorted_px, double depth_m) {
  const double z = kDepths * (depth_m - near_m_) / (far_m_ - near_m_);
  if (z >= 0 && z < kDepths) fields_[static_cast<std::size_t>(z)].add(undistorted_px);
}

double VolumeCoverage::share() const {
  std::size_t missing = 0;
  for (const auto& fields : fields_) missing += fields.with_fewer_than(kEnough).size();
  return 1 - static_cast<double>(missing) / (kDepths * ImageFields::kFields);
}

std::string VolumeCoverage::advice() const {
  constexpr std::array<std::string_view, kDepths> kDistances{"near the camera", "halfway",
                                                             "far from the camera"};
  const auto missing = [](const ImageFields& fields) {
    return fields.with_fewer_than(kEnough).size();
  };
  const auto emptiest = std::ranges::max_element(fields_, {}, missing);
  if (missing(*emptiest) == 0) return "The volume is covered.";
  const auto depth = static_cast<std::size_t>(emptiest - fields_.begin());
  const std::string where =
      fmt::format("{} ({:.1f} m)", kDistances[depth],
                  near_m_ + (static_cast<double>(depth) + 0.5) * (far_m_ - near_m_) / kDepths);
  if (missing(*emptiest) == ImageFields::kFields) return fmt::format("Move the hand {}.", where);
  return fmt::format("Move the hand to the {} of the image, {}.", emptiest->emptiest(), where);
}

}  // namespace handcast::calib
