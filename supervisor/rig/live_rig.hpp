// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "supervisor/record/recorder.hpp"
#include "supervisor/rig/applied_rig.hpp"
#include "supervisor/rig/ring_set.hpp"
#include "supervisor/rig/service_table.hpp"
#include "supervisor/rig/status.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {

/// The phases of a rig, in their order.
enum class Phase { starting, up, stopping, done };

/// The state of a running rig, shared by the parts of the supervisor. One thread.
struct LiveRig {
  /// A rig without rings and services. `loop` must outlive the object.
  LiveRig(const config::Rig& rig, EventLoop& loop, Service::OnNotice on_notice);
  LiveRig(const LiveRig&) = delete;

  /// Creates the missing rings of these services and records their stage marks. Returns the new
  /// rings. Errors: unavailable, bad_config. After an error some rings may exist, unused; the next
  /// call uses them.
  Result<daemon::Rings> make_rings(const std::vector<ServiceSpec>& specs);
  /// Gives the services that are started from now on these settings.
  void use(AppliedRig rig);
  /// Applies the section [supervisor] of a rig file.
  void take_settings(const config::Rig& rig);

  /// True if the rig is stopping or has stopped.
  bool stops() const { return phase == Phase::stopping || phase == Phase::done; }
  /// The argument of Service::tick(). While the rig stops, no service counts as silent.
  Service::Look look_at(const Service& service, std::int64_t now_ns) const;
  /// By when a service that is stopped and started now is ready, unless something is missing.
  std::int64_t settled_by(std::int64_t now_ns) const;
  /// The rig as it runs, swapped back ends included, as TOML.
  std::string text() const;
  /// The present state, for reports.
  RigView view() const;

  const std::string name;         ///< name of the rig
  config::Rig config;             ///< the applied rig, without swaps of back ends
  Phase phase = Phase::starting;  ///< the present phase
  std::int64_t started_ns;        ///< start of the rig, under whichever supervisor
  AppliedRig applied;             ///< what its services read
  Launch launch;                  ///< the parameters of its services
  Catalogue catalogue;            ///< the services that are installed
  RingSet rings;                  ///< its rings
  Recorder recorder;              ///< the record of its stage marks
  ServiceTable services;          ///< its services
};

}  // namespace handcast::supervisor
