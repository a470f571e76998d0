// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// The parts of a joint's name that say which one it is, and its side.
struct JointName {
  std::string key;           ///< "index-proximal"
  std::optional<Side> side;  ///< if the name says one
};

/// Reads the names of WebXR and OpenXR and what other programs make of them:
/// "Left_Index-Finger-Tip", "r-little-finger-tip", "wrist.L", "wrist.L.001", "LeftIndexProximal".
JointName parse_joint_name(const std::string& name);

/// The index into kJointNames; -1 if no joint has this key.
int joint_of(const std::string& key);

}  // namespace handcast::renderer
