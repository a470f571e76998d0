// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "ipc/daemon/description.hpp"

/// A rig with two cameras runs the programs of camera and landmarks twice. The second ones,
/// handcast-camera2 and handcast-landmarks2, are the same programs in a rig whose [camera],
/// [landmarks] and calibrated camera are those of the second view: nothing else in them differs.
namespace handcast::service {

/// The name of a stream, setting or section as the second view has it: "camera2.frames" for
/// "camera.frames". Names of other services ("pose.hands") are the same in both views.
std::string of_second_view(std::string_view name);

/// A sentence of code that does not know that it serves the second view: "camera 'v4l2': ... (set
/// camera.v4l2.device)" names the back end camera2 and camera2.v4l2.device. Only names of settings,
/// sections and streams, and the service at the begin, are changed.
std::string in_second_view(std::string_view sentence);

/// The description of a service for the second view.
daemon::ServiceDescription of_second_view(daemon::ServiceDescription description);

}  // namespace handcast::service
