// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/scene/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/sub_frames.hpp"

namespace handcast::preview {

Result<World> load_world(const config::Rig& rig) {
  auto calibration = calib::load_calibration(rig.calibration, rig.projector.packing);
  if (!calibration) return tl::make_unexpected(std::move(calibration.error()));
  World world{.calibration = *calibration,
              .mask = rig.cascade.mask,
              .predict = rig.cascade.predict,
              .hands = {}};
  for (const auto& [side, file] :
       {std::pair{msg::Side::left, rig.hand.left}, std::pair{msg::Side::right, rig.hand.right}}) {
    auto mesh = renderer::load_hand_or_default(file, side);
    if (!mesh) return tl::make_unexpected(std::move(mesh.error()));
    world.hands[static_cast<std::size_t>(side)] = std::move(*mesh);
  }
  return world;
}

static constexpr int kStep_px = 8;

FromCamera::FromCamera(const calib::Calibration& calibration)
    : columns_(calibration.camera.width_px / kStep_px + 2),
      rows_(calibration.camera.height_px / kStep_px + 2) {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      table_.emplace_back(calibration.to_projector(
          calibration.camera.undistort(glm::dvec2(column * kStep_px, row * kStep_px))));
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

}  // namespace handcast::preview
