// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace handcast::devices {

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

/// The devices of one kind of driver. A driver that is not in this build has none.
/// @{
std::vector<Attached> industrial_cameras();  ///< takes a second
std::vector<Attached> webcams();
std::vector<Attached> monitors();     ///< of the window system, for the output `window`
std::vector<Attached> connectors();   ///< of the graphics cards, for the output `kms`
std::vector<Attached> controllers();  ///< of DLP projectors
/// @}

/// All devices of a kind.
std::vector<Attached> attached_of(Kind kind);
/// Whatever is attached.
std::vector<Attached> all_attached();

/// What this build cannot see, a sentence each.
std::vector<std::string> blind_spots();

/// The kinds of trackers that are not attached, a sentence each.
std::vector<std::string> missing_trackers();

/// The list for people, with what to paste into a rig file.
std::string print(const std::vector<Attached>& attached,
                  const std::vector<std::string>& blind_spots,
                  const std::vector<std::string>& missing_trackers = {});
/// The same as JSON: an array of objects with the members of Attached.
std::string to_json(const std::vector<Attached>& attached);

}  // namespace handcast::devices
