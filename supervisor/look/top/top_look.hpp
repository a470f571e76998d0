// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ipc/ring/ring_view.hpp"
#include "supervisor/look/figures/figures.hpp"
#include "supervisor/look/top/process_usage.hpp"

namespace handcast::supervisor {

/// The state of a rig at one moment, observed from outside, for `handcast top` and the exporter.
struct RigLook {
  std::string rig;            ///< name of the rig
  std::int64_t taken_ns = 0;  ///< when it was observed, CLOCK_MONOTONIC
  std::string missing;        ///< why the supervisor does not answer; empty if it does
  /// The figures of the supervisor; the last ones if it does not answer, empty if it never has.
  std::optional<Figures> figures;
  std::vector<ipc::RingSnapshot> rings;     ///< the rings of the rig
  std::map<pid_t, ProcessUsage> processes;  ///< living services, standbys and readers
};

/// Observes a rig repeatedly. Rings and services are observed even while the supervisor is dead.
/// One thread.
class RigWatcher {
 public:
  /// A watcher of the rig with this name; connects at each observe().
  explicit RigWatcher(std::string rig) : rig_(std::move(rig)) {}

  /// Observes the rig. Waits at most 1 s for each answer of the supervisor.
  RigLook observe();

 private:
  void ask_supervisor();
  void open_rings();

  std::string rig_;
  std::string missing_;
  std::optional<Figures> figures_;
  std::vector<ipc::RingView> rings_;
};

}  // namespace handcast::supervisor
