// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/volume_coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace handcast::calib {
namespace {

constexpr double kWantedRange = 1.3;  ///< farthest to nearest
/// Not the corners: a whole hand does not fit into them.
constexpr std::array<int, 5> kWantedParts{1, 3, 4, 5, 7};
constexpr std::array<std::string_view, 9> kNames{
    "to the top left", "to the top",  "to the top right",   "to the left",  "into the middle",
    "to the right",    "to the bottom left", "to the bottom", "to the bottom right"};

}  // namespace

VolumeCoverage::VolumeCoverage(const CameraModel& camera)
    : width_px_(camera.width_px), height_px_(camera.height_px) {}

void VolumeCoverage::add(const glm::dvec2& undistorted_px, double distance) {
  if (!std::isfinite(undistorted_px.x) || !std::isfinite(undistorted_px.y)) return;
  const auto part_of = [](double share) {
    return std::clamp(static_cast<int>(std::floor(kParts * share)), 0, kParts - 1);
  };
  ++seen_[static_cast<std::size_t>(kParts * part_of(undistorted_px.y / height_px_) +
                                   part_of(undistorted_px.x / width_px_))];
  if (!(distance > 0) || !std::isfinite(distance)) return;
  nearest_ = nearest_ == 0 ? distance : std::min(nearest_, distance);
  farthest_ = std::max(farthest_, distance);
}

double VolumeCoverage::share() const {
  double parts = 0;
  for (const int part : kWantedParts)
    parts += std::min(1.0, static_cast<double>(seen_[static_cast<std::size_t>(part)]) / kEnough);
  const double range = nearest_ > 0 ? farthest_ / nearest_ : 1;
  return 0.5 * parts / kWantedParts.size() +
         0.5 * std::clamp((range - 1) / (kWantedRange - 1), 0.0, 1.0);
}

std::string VolumeCoverage::advice() const {
  for (const int part : kWantedParts)
    if (seen_[static_cast<std::size_t>(part)] < kEnough)
      return fmt::format("Move the hand {}", kNames[static_cast<std::size_t>(part)]);
  if (share() < 1) return "Move the hand nearer to the camera and farther away";
  return "Enough";
}

}  // namespace handcast::calib
