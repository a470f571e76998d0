#pragma once
#include <string>

#include "config/field.hpp"

namespace handcast::config {

struct Observer {
  bool enabled = true;
  double rate_hz = 20;
  int step_px = 3;
};

template <class Visitor>
void describe(Visitor& visitor, Observer& observer) {
  visitor.field("enabled", observer.enabled, "Score the live light against the twin's truth.");
  visitor.field("rate_hz", observer.rate_hz, between(0.1, 1000, "Hz"), "Projector frames scored a second.");
  visitor.field("step_px", observer.step_px, between(1, 16, "px"), "Distance of the surface points that are scored.");
}

struct Supervisor {
  double ready_s = 10;
  double stop_s = 3;
};

template <class Visitor>
void describe(Visitor& visitor, Supervisor& supervisor) {
  visitor.field("ready_s", supervisor.ready_s, between(0.1, 300, "s"), "A service that is not ready after this time is replaced.");
  visitor.field("stop_s", supervisor.stop_s, between(0.1, 60, "s"), "How long a service may take to stop before it is killed.");
}

}  // namespace handcast::config
