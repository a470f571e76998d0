// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace handcast::supervisor {

/// A rig that systemd is to run.
struct UnitSpec {
  std::string rig;                    ///< its name
  std::filesystem::path program;      ///< handcast itself
  std::filesystem::path rig_file;     ///< absolute
  std::vector<std::string> settings;  ///< --set path=value
  bool system = false;                ///< for the machine, not for one user's session
  std::string user;                   ///< that a system unit runs as
};

/// The name of the unit: "handcast-desk.service".
std::string unit_name(const UnitSpec& spec);
/// The text of the unit file, made from units/handcast.service.in.
std::string unit_text(const UnitSpec& spec);
/// The folder in which systemd looks for the unit: /etc/systemd/system, or the user's own.
std::filesystem::path unit_folder(const UnitSpec& spec);

}  // namespace handcast::supervisor
