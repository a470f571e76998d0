// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::twin {

/// A left hand at rest that is neither drawn nor a photograph of anybody: flesh about straight axes
/// (limb.hpp) with a smooth union, made into a mesh on a grid, and moved by weights that follow
/// from the parts. It shares no vertex, weight or measure with the hands of
/// services/lab/hand_maker. It is made once, in a fraction of a second. Any thread.
const renderer::HandMesh& implicit_hand();

}  // namespace handcast::twin
