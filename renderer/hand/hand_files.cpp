// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

std::filesystem::path default_hand_file(Side side) {
  const char* name = side == Side::left ? "hand_left.glb" : "hand_right.glb";
  if (const char* assets = std::getenv("HANDCAST_ASSETS"); assets && *assets)
    return std::filesystem::path(assets) / name;
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  return (program.parent_path() / ".." / "share" / "handcast" / name).lexically_normal();
}

Result<HandMesh> load_hand_or_default(const std::filesystem::path& file, Side side) {
  return load_hand(file.empty() ? default_hand_file(side) : file, side);
}

}  // namespace handcast::renderer
