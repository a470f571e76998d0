// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

#include "config/settings/field.hpp"

namespace handcast::config {

/// Whether still hands are compared with the calibration of the tracker.
enum class DriftWatch {
  measured,  ///< if `handcast calibrate` has measured where the tracker is
  always,
  never,
};
constexpr std::array<std::string_view, 3> words_of(DriftWatch) {
  return {"measured", "always", "never"};
}

/// [pose.drift]
struct Drift {
  DriftWatch watch = DriftWatch::measured;
  double warn_mm = 3;
  double warn_deg = 0.6;
};

template <class Visitor>
void describe(Visitor& visitor, Drift& drift) {
  visitor.field(
      "watch", drift.watch,
      "Whether the landmarks of still hands are compared with the tracker's joints. "
      "measured: if `handcast calibrate` has measured the tracker's place. The other two: "
      "always, never.");
  visitor.field("warn_mm", drift.warn_mm, between(0.5, 100, "mm"),
                "A tracker that has moved by more, across the camera's axis, is reported.");
  visitor.field("warn_deg", drift.warn_deg, between(0.1, 20, "deg"),
                "A tracker that has turned by more is reported.");
}

}  // namespace handcast::config
