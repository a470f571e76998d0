// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace handcast::supervisor {

/// A rig for systemd to run.
struct UnitSpec {
  std::string rig;                    ///< its name
  std::filesystem::path program;      ///< handcast itself
  std::filesystem::path rig_file;     ///< absolute
  std::vector<std::string> settings;  ///< --set path=value
  bool system = false;                ///< for the machine, not for one user's session
  std::string user;                   ///< as whom it runs, of a system unit
};

/// "handcast-desk.service".
std::string unit_name(const UnitSpec& spec);
/// The unit file's text, made from units/handcast.service.in.
std::string unit_text(const UnitSpec& spec);
/// Where systemd looks for it: /etc/systemd/system, or the user's own folder.
std::filesystem::path unit_folder(const UnitSpec& spec);

}  // namespace handcast::supervisor
