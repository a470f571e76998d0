// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/rig.hpp"

namespace handcast::config {

/// A service that runs somebody else's program, which a back end `external` listens to.
struct Guest {
  std::string_view service;  ///< its name: "pose_guest"
  std::string_view feeds;    ///< the service with that back end: "pose"
  const External& (*settings)(const Rig&);
  bool (*is_heard)(const Rig&);  ///< whether that service has the back end

  std::string section() const { return std::string(feeds) + ".external"; }
  /// The ring that the program writes to.
  std::string stream() const { return "guest." + std::string(feeds); }
  /// Whether the rig starts the program.
  bool is_wanted(const Rig& rig) const { return is_heard(rig) && !settings(rig).command.empty(); }
};

/// All that there can be.
inline constexpr std::array kGuests{
    Guest{"camera_guest", "camera",
          [](const Rig& rig) -> const External& { return rig.camera.external; },
          [](const Rig& rig) { return rig.camera.backend == "external"; }},
    Guest{"camera2_guest", "camera2",
          [](const Rig& rig) -> const External& { return rig.camera2.external; },
          [](const Rig& rig) { return rig.camera2.backend == "external"; }},
    Guest{"pose_guest", "pose", [](const Rig& rig) -> const External& { return rig.pose.external; },
          [](const Rig& rig) {
            return rig.pose.backend == "external" || rig.pose.second == "external";
          }},
    Guest{"landmarks_guest", "landmarks",
          [](const Rig& rig) -> const External& { return rig.landmarks.external; },
          [](const Rig& rig) { return rig.landmarks.backend == "external"; }},
    Guest{"landmarks2_guest", "landmarks2",
          [](const Rig& rig) -> const External& { return rig.landmarks2.external; },
          [](const Rig& rig) { return rig.landmarks2.backend == "external"; }},
};

}  // namespace handcast::config
