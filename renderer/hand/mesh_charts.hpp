// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Fills HandMesh::chart. A UV chart is a part of the mesh that is connected by triangles, or by
/// vertices with the same position and texture coordinates. Charts are numbered from 1 in the order
/// of their first vertices; all charts from the 60th on get number 60.
void number_charts(HandMesh& hand);

}  // namespace handcast::renderer
