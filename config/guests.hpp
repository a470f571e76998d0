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

/// The guest of the service with this section of a rig.
template <auto kSection>
constexpr Guest guest_of(std::string_view service, std::string_view feeds) {
  return {service, feeds,
          [](const Rig& rig) -> const External& { return (rig.*kSection).external; },
          [](const Rig& rig) {
            const auto& section = rig.*kSection;
            if constexpr (requires { section.second; })
              if (section.second == "external") return true;
            return section.backend == "external";
          }};
}

/// All that there can be.
inline constexpr std::array kGuests{
    guest_of<&Rig::camera>("camera_guest", "camera"),
    guest_of<&Rig::camera2>("camera2_guest", "camera2"),
    guest_of<&Rig::pose>("pose_guest", "pose"),
    guest_of<&Rig::landmarks>("landmarks_guest", "landmarks"),
    guest_of<&Rig::landmarks2>("landmarks2_guest", "landmarks2"),
};

}  // namespace handcast::config
