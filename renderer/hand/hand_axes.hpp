// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <string>

#include "renderer/hand/hand_mesh.hpp"

/// What the places of a model's joints say about it, whatever program and habit made their axes.
namespace handcast::renderer {

/// The joints that a model has; the others have the frame of their parent.
using FoundJoints = std::array<bool, kJoints>;

/// True if wrist and knuckles do not lie in a line.
bool has_palm(const JointFrames& rest);
/// Which hand it is: the thumb and the tips of the fingers lie on the side of the palm. Empty if
/// all joints lie in a plane.
std::optional<Side> side_of_joints(const JointFrames& rest);

/// Gives HandMesh::rest the axes of OpenXR: -z along the bone, +y out of the back. Axes that fit
/// the bones are left alone. Those that differ from them by a common turn (Blender's bones lie
/// along +y) are turned back; others are taken from the bones and the palm. Returns what was done,
/// a sentence without its full stop; empty: nothing.
std::string settle_axes(HandMesh& hand, const FoundJoints& found);

/// Bends all fingers: why the mesh does not look like a hand then. Empty if it does.
std::string fault_when_bent(const HandMesh& hand);

}  // namespace handcast::renderer
