// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::daemon {

/// What a device can be in a rig.
enum class Kind { camera, display, controller, tracker };
inline constexpr std::array<std::string_view, 4> kKindNames{"cameras", "displays", "controllers",
                                                            "trackers"};

/// Sizes of the images that a device takes or shows.
struct Mode {
  std::string format;  ///< of a camera's pixels, as in a rig file; empty: nothing to choose
  /// The smallest and the largest size in pixels; the same for a single one.
  /// @{
  int least_width_px = 0, least_height_px = 0;
  int width_px = 0, height_px = 0;
  /// @}
  double rate_hz = 0;  ///< the highest in the largest size; 0: the device does not say
};

/// A device of this computer.
struct Attached {
  Kind kind = Kind::camera;
  std::string name;   ///< for people: "Basler acA720-520um, serial number 23456789"
  std::string about;  ///< what it can do: formats, sizes, rates; may be empty
  /// The lines of a rig file that use it: a setting and its value.
  std::vector<std::pair<std::string, std::string>> settings;
  std::string trouble{};  ///< why it cannot be opened now, with the remedy; empty if it can
  /// What a rig file or a calibration may call it, the most telling name first.
  std::vector<std::string> names{};
  /// Those that handcast reads or shows; of a camera, its best format first; of a display, its
  /// preferred or current mode first. Empty: not known.
  std::vector<Mode> modes{};
  bool is_operators = false;  ///< a display that is probably the operator's own, and no projector
};

/// Which devices are looked for.
struct Search {
  std::string name{};  ///< those that a rig file means by it; empty: all
  bool opens = true;   ///< opens them for a moment, to see whether that is possible
};

/// Devices as JSON: an array of objects with the members of Attached.
std::string to_json(const std::vector<Attached>& attached);
/// Reads what to_json() wrote. Errors: bad_data (not JSON, a member is missing or of another type).
Result<std::vector<Attached>> attached_from(std::string_view json);

}  // namespace handcast::daemon
