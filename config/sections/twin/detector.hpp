// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/twin/fault.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [twin.detector]
struct TwinDetector {
  double age_ms = 16.2;
  double age_sd_ms = 1.9;
  double noise_px = 1;
  double bias_px = 0;
  double bias_ms = 300;
  double bias_hidden = 1;
  double dropout = 0;
  double outliers = 0;
  double near_outliers = 0;
  double clock_skew_ms = 0;
  Fault lost, wrong_finger, merged;

  bool operator==(const TwinDetector&) const = default;
};

template <class Visitor>
void describe(Visitor& visitor, TwinDetector& detector) {
  visitor.field(
      "age_ms", detector.age_ms, between(0, 500, "ms"),
      "Mean time from the middle of an exposure to its landmarks; one detection follows the other "
      "without a pause. In the simulator, noise_px and the settings of the bias apply only to the "
      "twin's model of a detector, the others to every landmarks.backend.");
  visitor.field("age_sd_ms", detector.age_sd_ms, between(0, 50, "ms"),
                "Standard deviation of that time.");
  visitor.field("noise_px", detector.noise_px, between(0, 50, "px"),
                "White noise per landmark and axis.");
  visitor.field("bias_px", detector.bias_px, between(0, 50, "px"),
                "Error that depends on the pose and lasts: RMS per landmark and axis, more at the "
                "tips than at the palm.");
  visitor.field("bias_ms", detector.bias_ms, between(1, 10000, "ms"),
                "How long that error lasts in a moving hand: the time in which its autocorrelation "
                "falls to 1/e.");
  visitor.field("bias_hidden", detector.bias_hidden, between(1, 10),
                "Factor of that error for landmarks that the hand itself hides.");
  visitor.field("dropout", detector.dropout, between(0, 1),
                "Share of detections that find nothing.");
  visitor.field("outliers", detector.outliers, between(0, 1),
                "Share of landmarks that are displaced by 40-200 px.");
  visitor.field("near_outliers", detector.near_outliers, between(0, 1),
                "Share of landmarks that are displaced by 5-40 px.");
  visitor.field("clock_skew_ms", detector.clock_skew_ms, between(-200, 200, "ms"),
                "Error of the time stamps; positive: detections seem younger than they are.");
  describe_fault(visitor, detector.lost, "lost_at_s", "lost_s",
                 "Fault: how long the detector finds nothing.");
  describe_fault(visitor, detector.wrong_finger, "wrong_finger_at_s", "wrong_finger_s",
                 "Fault: how long the detector exchanges the index and middle fingers.");
  describe_fault(visitor, detector.merged, "merged_at_s", "merged_s",
                 "Fault: how long the detector sees the index and the middle finger as one.");
}

}  // namespace handcast::config
