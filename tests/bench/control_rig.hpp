// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ipc/control/control_message.hpp"
#include "ipc/ring/ring_view.hpp"

namespace handcast::bench {

/// A temporary folder with a copy of config/rigs/twin.toml, whose camera can also replay a short
/// recording. It is the HANDCAST_SCOPE of this process, so that its rigs meet no others. The
/// programs are those of HANDCAST_BIN, or those beside this program.
class RigFolder {
 public:
  RigFolder();
  ~RigFolder();
  RigFolder(const RigFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  const std::filesystem::path& programs() const { return programs_; }
  std::filesystem::path rig_file() const { return folder_ / "rig.toml"; }
  /// Writes the rig file with another value of projector.software_ms, which only the projector
  /// reads.
  void change_a_projector_setting();

 private:
  void record() const;

  std::filesystem::path folder_, programs_;
  std::string rig_text_;
  int changes_ = 0;
};

/// `handcast up` of the folder's rig, from the moment when all services are ready.
class TwinRig {
 public:
  /// `settings`: for --set.
  TwinRig(const RigFolder& folder, const std::vector<std::string>& settings);
  ~TwinRig();  ///< `handcast down`
  TwinRig(const TwinRig&) = delete;

  pid_t pid_of(const std::string& service) const;
  ipc::RingView view_of(const std::string& stream) const;
  /// Waits until all services are ready, and `standby`, if it is not empty, has a spare. Then lets
  /// the rig work for a moment.
  void settle(const std::string& standby) const;
  /// Sends a request and waits for its answer. Ends the benchmark if it is refused.
  nlohmann::json ask(const control::Request& request) const;

 private:
  bool is_ready(const std::string& standby) const;

  pid_t pid_ = -1;
};

}  // namespace handcast::bench
