// SPDX-License-Identifier: Apache-2.0

#include "ipc/base/program.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

std::filesystem::path default_hand_file(Side side) {
  return assets_folder() / (side == Side::left ? "hand_left.glb" : "hand_right.glb");
}

Result<HandMesh> load_hand_or_default(const std::filesystem::path& file, Side side) {
  return load_hand(file.empty() ? default_hand_file(side) : file, side);
}

}  // namespace handcast::renderer
