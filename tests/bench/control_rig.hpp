// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/rig_process.hpp"

namespace handcast::bench {

/// A folder with a copy of config/rigs/twin.toml, whose camera can also replay a short recording.
/// The programs are those of HANDCAST_BIN, or those beside this program.
class RigFolder {
 public:
  RigFolder();

  const std::filesystem::path& path() const { return scope_.path(); }
  const std::filesystem::path& programs() const { return programs_; }
  std::filesystem::path rig_file() const { return path() / "rig.toml"; }
  /// Writes the rig file with another value of projector.software_ms, which only the projector
  /// reads.
  void change_a_projector_setting();

 private:
  void record() const;

  RigScope scope_;
  std::filesystem::path programs_;
  std::string rig_text_;
  int changes_ = 0;
};

/// The folder's rig, from the moment when all services are ready.
class TwinRig : public RigProcess {
 public:
  /// `settings`: for --set.
  TwinRig(const RigFolder& folder, const std::vector<std::string>& settings);

  /// Waits until all services are ready, and `standby`, if it is not empty, has a standby. Then
  /// lets the rig work for a moment.
  void settle(const std::string& standby) const;
};

}  // namespace handcast::bench
