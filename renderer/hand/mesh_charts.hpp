// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// The UV charts are the parts of the mesh that hang together by triangles, or by vertices equal in
/// place and texture coordinate. Numbered from 1 by their first vertex; what goes beyond 60 parts
/// shares the last number.
void number_charts(HandMesh& hand);

}  // namespace handcast::renderer
