// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/settings/field.hpp"

namespace handcast::config {

/// The axes in which an OpenXR runtime reports the joints. All: x right, y up, -z forward, metres.
enum class OpenXrSpace {
  local,  ///< fixed to the room; its origin is where the headset was at first
  stage,  ///< fixed to the room; its origin is on the floor
  view,   ///< fixed to the headset
};
constexpr std::array<std::string_view, 3> words_of(OpenXrSpace) {
  return {"local", "stage", "view"};
}

/// [pose.openxr]
struct OpenXr {
  std::string runtime;
  OpenXrSpace space = OpenXrSpace::local;
  double rate_hz = 120;
  double age_ms = 10;
  double predict_ms = 0;
};

template <class Visitor>
void describe(Visitor& visitor, OpenXr& openxr) {
  visitor.field("runtime", openxr.runtime,
                "The manifest (.json) of the OpenXR runtime; relative to the rig file. Empty: the "
                "one that is active on this computer, as `handcast devices` shows it.");
  visitor.field("space", openxr.space,
                "The axes of the joints. local, stage: fixed to the room. view: fixed to the "
                "headset, for a tracker that is mounted on it. The calibration counts for one.");
  visitor.field("rate_hz", openxr.rate_hz, between(10, 500, "Hz"),
                "How often the runtime is asked; about the rate of its tracker.");
  visitor.field("age_ms", openxr.age_ms, between(0, 100, "ms"),
                "How long ago the newest joints were measured that the runtime has: it is asked "
                "for those of that time, because it does not say when it measured them.");
  visitor.field("predict_ms", openxr.predict_ms, between(0, 40, "ms"),
                "The runtime is asked for the joints this long from now, and predicts them; about "
                "the time until the light. 0: for those of age_ms ago, and handcast predicts.");
}

}  // namespace handcast::config
