// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include "config/rig.hpp"

namespace handcast::config {

/// The rig as the services of the second view read it: [camera2] and [landmarks2] in the places of
/// [camera] and [landmarks].
inline Rig seen_by_second(Rig rig) {
  rig.camera = rig.camera2;
  rig.landmarks = rig.landmarks2;
  return rig;
}

/// True if the rig has two cameras: a second one, or one that delivers the images of both.
inline bool has_second_view(const Rig& rig) {
  return rig.camera2.backend != "none" || rig.pose.backend == "stereo";
}

}  // namespace handcast::config
