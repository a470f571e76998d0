// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::config {

/// The cameras of a rig. Each has a service and a section of its own, and so has the landmark
/// detector on its images: camera and landmarks, camera2 and landmarks2.
enum class Viewpoint { first, second };

}  // namespace handcast::config
