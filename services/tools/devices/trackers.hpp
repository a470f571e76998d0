// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/tools/devices/attached.hpp"

namespace handcast::devices {

/// A device of Ultraleap's on the USB.
struct UsbTracker {
  std::string name;         ///< for people: "Leap Motion Controller (f182:0003)"
  std::string port;         ///< the kernel's name of its place: "1-4.2"
  bool is_leap_v1 = false;  ///< the first controller, whose images the camera `leap` reads
};

/// Those that are attached, by their USB ids. `root`: where /sys is, for tests.
std::vector<UsbTracker> usb_trackers(const std::filesystem::path& root = "/");

/// Ultraleap's library for the back end `leapc`, in its usual places. It is not loaded. nullopt: it
/// is in none of them.
std::optional<std::string> leapc_library(const std::filesystem::path& root = "/");
/// What to do if there is none.
std::string leapc_remedy();

/// A kind of tracker of which this computer has none.
struct AbsentTracker {
  std::string backend;  ///< the word of pose.backend
  std::string why;      ///< what is missing, with the remedy
};
/// Those of which trackers() has no entry.
std::vector<AbsentTracker> absent_trackers(const std::filesystem::path& root = "/");

/// The entries of Kind::tracker: Ultraleap's devices or, without one, its library; the active
/// OpenXR runtime, by its manifest.
std::vector<Attached> trackers(const std::filesystem::path& root = "/");

}  // namespace handcast::devices
