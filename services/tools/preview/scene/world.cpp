// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/scene/world.hpp"

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

}  // namespace handcast::preview
