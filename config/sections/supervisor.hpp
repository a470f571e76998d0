// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [observer]
struct Observer {
  bool enabled = true;
  double rate_hz = 20;
  int step_px = 4;
  Process process{.wait = ipc::Wait::futex};
};

template <class Visitor>
void describe(Visitor& visitor, Observer& observer) {
  visitor.field("enabled", observer.enabled,
                "Score the live light against the true hand of the twin.");
  visitor.field("rate_hz", observer.rate_hz, between(0.1, 1000, "Hz"),
                "Projector frames scored per second.");
  visitor.field(
      "step_px", observer.step_px, between(1, 16, "px"),
      "Distance between the surface points that are scored; rounded up to a multiple of 4.");
  visitor.section("process", observer.process, "The process of the service.");
}

/// [supervisor]
struct Supervisor {
  double ready_s = 10;
  double stop_s = 3;
  double silent_s = 2;
  double history_s = 60;
  int metrics_port = 0;
};

template <class Visitor>
void describe(Visitor& visitor, Supervisor& supervisor) {
  visitor.field("ready_s", supervisor.ready_s, between(0.1, 300, "s"),
                "A service that is not ready after this time is replaced.");
  visitor.field("stop_s", supervisor.stop_s, between(0.1, 60, "s"),
                "How long a service, or the whole rig, may take to stop before it is killed.");
  visitor.field("silent_s", supervisor.silent_s, between(0.2, 300, "s"),
                "A service without a heartbeat for this time is killed and replaced; after a "
                "quarter of it if the service is stopped, after half if it sleeps. Until it is "
                "ready, waiting for a processor or the disk does not count.");
  visitor.field("history_s", supervisor.history_s, between(1, 3600, "s"),
                "How much of the past `handcast trace` and `handcast latency` can show.");
  visitor.field("metrics_port", supervisor.metrics_port, between(0, 65535),
                "The port of http://127.0.0.1:PORT/metrics, where metrics are served to "
                "Prometheus. 0: no server.");
}

}  // namespace handcast::config
