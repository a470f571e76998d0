// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/settings/field.hpp"

namespace handcast::config {

/// What Ultraleap's service takes its device to be mounted on.
enum class LeapMode {
  desktop,    ///< on a table, looking up
  hmd,        ///< on a head
  screentop,  ///< above a screen, looking down
  unchanged,  ///< as it is set in the service
};
constexpr std::array<std::string_view, 4> words_of(LeapMode) {
  return {"desktop", "hmd", "screentop", "unchanged"};
}

/// [pose.leapc]
struct Leapc {
  std::string library;
  std::string device;
  LeapMode mode = LeapMode::desktop;
  double age_ms = 9;
};

template <class Visitor>
void describe(Visitor& visitor, Leapc& leapc) {
  visitor.field("library", leapc.library,
                "Ultraleap's libLeapC.so; relative to the rig file. Empty: where its installers "
                "put it, and where the linker finds it.");
  visitor.field("device", leapc.device,
                "Serial number of the device, which the log names. Empty: the one that the service "
                "has chosen.");
  visitor.field("mode", leapc.mode,
                "How the device is mounted. desktop: on a table, it looks up. hmd: on a head. "
                "screentop: above, it looks down. unchanged: as set in Ultraleap's control panel. "
                "The service has one mode for all programs.");
  visitor.field("age_ms", leapc.age_ms, between(0, 200, "ms"),
                "The least age of a sample when it arrives. Used only if the service's time stamps "
                "cannot be those of its clock.");
}

}  // namespace handcast::config
