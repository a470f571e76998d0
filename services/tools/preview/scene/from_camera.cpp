// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/scene/from_camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace handcast::preview {
namespace {

constexpr int kStep_px = 8;
constexpr float kSmooth_px = 8;  ///< nearer to a joint than this, its depth holds

/// True up to one image outside of the image; farther out the polynomial of the lens may fold.
bool is_near(const calib::CameraModel& camera, glm::dvec2 px) {
  return std::abs(px.x) < 2.0 * camera.width_px && std::abs(px.y) < 2.0 * camera.height_px;
}

bool is_coaxial(const calib::ProjectorModel& projector) {
  return projector.parallax == glm::dvec3(0);
}

}  // namespace

FromCamera::FromCamera(const calib::Calibration& calibration)
    : calibration_(calibration),
      columns_(calibration.camera.width_px / kStep_px + 2),
      rows_(calibration.camera.height_px / kStep_px + 2) {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      undistorted_.push_back(
          calibration.camera.undistort(glm::dvec2(column * kStep_px, row * kStep_px)));
  fill_table();
}

void FromCamera::place(std::vector<glm::vec3> joints) {
  if (is_coaxial(calibration_.projector)) return;
  joints_ = std::move(joints);
  fill_table();
}

void FromCamera::fill_table() {
  table_.clear();
  for (std::size_t i = 0; i < undistorted_.size(); ++i) {
    const glm::vec2 node(i % static_cast<std::size_t>(columns_),
                         i / static_cast<std::size_t>(columns_));
    table_.emplace_back(calibration_.projector.pixel_of(
        undistorted_[i], depth_at(node * static_cast<float>(kStep_px))));
  }
}

double FromCamera::depth_at(glm::vec2 image_px) const {
  double sum = 0, weights = 0;
  for (const auto& joint : joints_) {
    const auto from = image_px - glm::vec2(joint);
    const double weight = 1 / (glm::dot(from, from) + kSmooth_px * kSmooth_px);
    sum += weight * joint.z;
    weights += weight;
  }
  return weights > 0 ? sum / weights : calibration_.projector.plane_m;
}

glm::vec2 FromCamera::operator()(glm::vec2 image_px) const {
  const glm::vec2 at = image_px / static_cast<float>(kStep_px);
  const int column = std::clamp(static_cast<int>(std::floor(at.x)), 0, columns_ - 2),
            row = std::clamp(static_cast<int>(std::floor(at.y)), 0, rows_ - 2);
  const float u = at.x - static_cast<float>(column), v = at.y - static_cast<float>(row);
  const auto* top = &table_[static_cast<std::size_t>(row) * columns_ + column];
  const auto* bottom = top + columns_;
  return (1 - v) * ((1 - u) * top[0] + u * top[1]) + v * ((1 - u) * bottom[0] + u * bottom[1]);
}

std::optional<glm::vec2> FromCamera::image_px_of(glm::vec2 projector_px) const {
  constexpr int kRounds = 4;  // the depth changes slowly across a hand
  const auto& [projector, camera] = std::tie(calibration_.projector, calibration_.camera);
  auto px = projector.camera_pixel_of(projector_px);
  for (int i = 0; i < kRounds && !is_coaxial(projector) && is_near(camera, px); ++i) {
    const auto parallax =
        projector.pixel_of(px, depth_at(camera.distort(px))) - projector.pixel_of(px);
    px = projector.camera_pixel_of(glm::dvec2(projector_px) - parallax);
  }
  if (!is_near(camera, px)) return std::nullopt;
  return glm::vec2(camera.distort(px));
}

}  // namespace handcast::preview
