// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/twin/implicit/parts.hpp"

namespace handcast::twin {

/// Sets the skin weights of a mesh at rest, whose positions are in metres: the parts share each
/// vertex by their distances to it, and the joints of a part share it by its place along the part.
/// Neighbours are averaged, and the four largest weights remain.
void set_part_weights(renderer::HandMesh& mesh, std::span<const Part> parts);

}  // namespace handcast::twin
