// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace handcast::supervisor {

/// The parameters of a systemd unit that runs a rig.
struct UnitSpec {
  std::string rig;                    ///< name of the rig
  std::filesystem::path program;      ///< absolute path of `handcast`
  std::filesystem::path rig_file;     ///< absolute path of the rig file
  std::vector<std::string> settings;  ///< --set path=value
  /// Absolute path of the folder for kept files; empty: the unit's own state folder.
  std::filesystem::path out;
  bool system = false;  ///< a unit of the system; false: of the user's session
  /// handcast@.service: each instance runs the rig of its name; see template_spec().
  bool is_template = false;
  std::string user;                 ///< the user of a system unit
  std::vector<std::string> groups;  ///< further groups of a system unit
  bool real_time = false;           ///< a service wants a real-time priority
  bool window = false;              ///< the light is a window
  /// The display of a system unit with a window.
  /// @{
  std::string display, x_authority;
  /// @}
};

/// Those of the groups to which devices of a rig belong (video, render, input, plugdev) that this
/// machine has.
std::vector<std::string> device_groups();

/// The unit of Debian's package, which runs the rig /etc/handcast/RIG.toml as the package's user.
/// It depends on nothing of this machine.
UnitSpec template_spec(std::filesystem::path program);

/// The name of the unit: "handcast-desk.service", or "handcast@.service".
std::string unit_name(const UnitSpec& spec);
/// The text of the unit file, made from units/handcast.service.in.
std::string unit_text(const UnitSpec& spec);
/// The folder of the unit: /etc/systemd/system, or systemd/user in the user's configuration folder.
std::filesystem::path unit_folder(const UnitSpec& spec);

}  // namespace handcast::supervisor
