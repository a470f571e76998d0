// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ipc/ring/ring_view.hpp"
#include "supervisor/top/process_usage.hpp"

namespace handcast::supervisor {

/// A rig from outside at one moment: what `handcast top` and the exporter are made of.
struct RigLook {
  std::string rig;
  std::int64_t taken_ns = 0;
  std::string missing;  ///< why its supervisor does not answer; "" where it does
  nlohmann::json
      status;  ///< as `handcast status --json`; the last there was while the supervisor is missing
  std::vector<ipc::RingSnapshot> rings;
  std::map<pid_t, ProcessUsage> processes;  ///< services, spares and readers that live
};

/// Looks at a rig again and again without taking part. Rings and services are seen while their
/// supervisor is dead, too.
class RigWatcher {
 public:
  explicit RigWatcher(std::string rig) : rig_(std::move(rig)) {}

  RigLook look();

 private:
  void ask_supervisor();
  void open_rings();

  std::string rig_;
  std::string missing_;
  nlohmann::json status_;
  std::vector<ipc::RingView> rings_;
};

/// A service's process in a status: "pid", "standby"; 0 where there is none.
pid_t pid_in(const nlohmann::json& service, const char* key);

}  // namespace handcast::supervisor
