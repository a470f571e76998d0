// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "supervisor/record/recorder.hpp"
#include "supervisor/rig/ring_set.hpp"
#include "supervisor/rig/service_table.hpp"
#include "supervisor/rig/status.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {

enum class Phase { starting, up, stopping, done };

/// A rig while its supervisor runs: what the parts of the supervisor work on.
struct LiveRig {
  LiveRig(const config::Rig& rig, EventLoop& loop, Service::OnNotice on_notice);
  LiveRig(const LiveRig&) = delete;

  /// Makes the rings that these services need and that are not there, and follows their stage
  /// marks. Returns the new rings. Errors: unavailable, bad_config; rings may have been made then,
  /// which is harmless: nobody uses them until the next try.
  Result<daemon::Rings> make_rings(const std::vector<ServiceSpec>& specs);
  /// Takes the settings that the supervisor itself reads.
  void take_settings(const config::Rig& rig);

  bool stops() const { return phase == Phase::stopping || phase == Phase::done; }
  Service::Look look_at(const Service& service, std::int64_t now_ns) const;
  RigView view() const;

  const std::string name;
  config::Rig config;  ///< as the file was when it was last applied
  Phase phase = Phase::starting;
  std::int64_t started_ns;
  Launch launch;
  Catalogue catalogue;  ///< of the services that are installed
  RingSet rings;
  Recorder recorder;
  ServiceTable services;
};

}  // namespace handcast::supervisor
