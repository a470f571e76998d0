// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::config {

/// What a rig may have two of. Each camera has a service and a section of its own, and so has the
/// landmark detector on its images: camera and landmarks, camera2 and landmarks2. So has each
/// projector: projector and projector2.
enum class Viewpoint { first, second };

/// The other one.
constexpr Viewpoint other_of(Viewpoint at) {
  return at == Viewpoint::first ? Viewpoint::second : Viewpoint::first;
}

}  // namespace handcast::config
