// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Why a mesh whose numbers are finite cannot be a hand in metres: its size, its bones, its
/// surface, or its texture coordinates. Empty if it can. A mesh that passes takes a bounded time to
/// draw and to paint, even if its triangles overlap.
std::string fault_of_mesh(const HandMesh& hand);

}  // namespace handcast::renderer
