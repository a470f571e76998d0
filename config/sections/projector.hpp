// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

struct Projector {
  std::string backend = "twin";
  double rate_hz = 946;
  double latency_ms = 3.0;
  double software_ms = 1.2;
  double frame_wait_ms = 0;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Projector& projector) {
  visitor.field("backend", projector.backend,
                "Where light goes; `handcast-projector --backends` lists what this build has.");
  visitor.field("rate_hz", projector.rate_hz, between(1, 10000, "Hz"),
                "Frames a second asked of the projector.");
  visitor.field("latency_ms", projector.latency_ms, between(0, 200, "ms"),
                "From handing over a frame to the start of its light.");
  visitor.field("software_ms", projector.software_ms, between(0, 100, "ms"),
                "From the newest inputs to the frame handed over: what the simulator lets the "
                "software take, and the horizon of the first "
                "live frames (later ones use the measured time).");
  visitor.field("frame_wait_ms", projector.frame_wait_ms, between(0, 100, "ms"),
                "How long a projector frame may wait for a newer camera image. 0: not at all.");
  visitor.section("process", projector.process, "How the service runs.");
}

struct Content {
  std::string left = "builtin:atlas";
  std::string right = "builtin:atlas";
  double shading = 0.0;
};

template <class Visitor>
void describe(Visitor& visitor, Content& content) {
  visitor.field("left", content.left,
                "What the left hand wears: a PNG picture in the hand's texture layout, or "
                "builtin:atlas, builtin:checker, "
                "builtin:skeleton, builtin:white.");
  visitor.field("right", content.right, "What the right hand wears.");
  visitor.field("shading", content.shading, between(0, 1),
                "How much a light from the projector's side shades the drawing. 0: not at all.");
}

struct Hand {
  std::string left;
  std::string right;
};

template <class Visitor>
void describe(Visitor& visitor, Hand& hand) {
  visitor.field("left", hand.left,
                "A skinned glTF hand with WebXR joint names to draw as the left hand. Empty: the "
                "one made by handcast.");
  visitor.field("right", hand.right, "The same for the right hand.");
}

}  // namespace handcast::config
