// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/rig.hpp"

namespace handcast::config {

/// Whether a camera delivers the images of two eyes, so that it needs no second service.
inline bool has_two_eyes(const Camera& camera) { return camera.backend == "leap"; }

/// Whether the rig has images of a second camera: from a service of its own, or from a camera that
/// delivers those of two eyes.
inline bool has_second_images(const Rig& rig) {
  return rig.camera2.backend != "none" || has_two_eyes(rig.camera);
}

/// True if the rig has two cameras: a second one, or one that delivers the images of both.
inline bool has_second_view(const Rig& rig) {
  return rig.camera2.backend != "none" || rig.pose.backend == "stereo";
}

}  // namespace handcast::config
