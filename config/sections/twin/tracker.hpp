// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/twin/clock.hpp"
#include "config/sections/twin/fault.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [twin.tracker]
struct TwinTracker {
  double rate_hz = 110.6;
  double age_ms = 9.1;
  double age_sd_ms = 0.4;
  double scale = 1.05;
  double offset_mm = 5;
  double rotation_deg = 0.5;
  double drift_px = 3;
  double noise_mm = 0.1;
  double dropout = 0;
  double joint_offset_mm = 0;
  double finger_correlation = 0;
  double flexion_bias = 0;
  double hidden_deg = 0;
  double hidden_s = 1.5;
  double snap_hz = 0;
  double snap_deg = 25;
  double lag_ms = 0;
  double burst = 0;
  double clock_skew_ms = 0;
  TwinClock clock;
  Fault frozen, decaying, lost, wrong_finger, merged, swapped;

  bool operator==(const TwinTracker&) const = default;
};

template <class Visitor>
void describe(Visitor& visitor, TwinTracker& tracker) {
  visitor.field("rate_hz", tracker.rate_hz, between(1, 1000, "Hz"), "Samples per second.",
                Effect::restart);
  visitor.field("age_ms", tracker.age_ms, between(0, 500, "ms"),
                "Mean age of a sample when it arrives.");
  visitor.field("age_sd_ms", tracker.age_sd_ms, between(0, 50, "ms"),
                "Standard deviation of that age.");
  visitor.field("scale", tracker.scale, between(0.5, 2),
                "Size of the reported hand relative to the true one, scaled about the wrist.");
  visitor.field("offset_mm", tracker.offset_mm, between(0, 200, "mm"),
                "Error of the hand's position, in a direction drawn from the seed.");
  visitor.field("rotation_deg", tracker.rotation_deg, between(0, 45, "deg"),
                "Error of the hand's rotation, about an axis drawn from the seed.");
  visitor.field("drift_px", tracker.drift_px, between(0, 100, "px"),
                "Slow drift of each joint at 0.2-1.5 Hz: RMS per axis, in camera pixels at the "
                "distance of the hand.");
  visitor.field("noise_mm", tracker.noise_mm, between(0, 50, "mm"),
                "White noise per joint and axis.");
  visitor.field("joint_offset_mm", tracker.joint_offset_mm, between(0, 30, "mm"),
                "Constant error of each joint in the axes of its bone, drawn for the person: the "
                "tracker's joints are not where the hand's are.");
  visitor.field("finger_correlation", tracker.finger_correlation, between(0, 1),
                "Share of the variance of the drift that is common to the joints of a finger.");
  visitor.field("flexion_bias", tracker.flexion_bias, between(-0.5, 0.9),
                "Share of each finger's flexion that is missing from the report.");
  visitor.field("hidden_deg", tracker.hidden_deg, between(0, 90, "deg"),
                "Standard deviation of the error of a finger's flexion while the hand hides the "
                "finger from the tracker: a guess at full confidence.");
  visitor.field("hidden_s", tracker.hidden_s, between(0.05, 60, "s"),
                "How long such a guess lasts, on average.");
  visitor.field("snap_hz", tracker.snap_hz, between(0, 20, "Hz"),
                "Number of finger snaps per hand and second: a finger jumps to a wrong flexion for "
                "0.05 to 0.4 s.");
  visitor.field("snap_deg", tracker.snap_deg, between(0, 90, "deg"), "Size of a snap.");
  visitor.field("lag_ms", tracker.lag_ms, between(0, 100, "ms"),
                "Delay of the fingers relative to the wrist by the tracker's own smoothing; the "
                "wrist has a third of it. The stamps do not know of it.");
  visitor.field("dropout", tracker.dropout, between(0, 1), "Share of samples that are lost.");
  visitor.field("burst", tracker.burst, between(0, 1),
                "Share of samples that arrive late, together with the next one.");
  visitor.field("clock_skew_ms", tracker.clock_skew_ms, between(-200, 200, "ms"),
                "Error of the time stamps; positive: samples seem younger than they are.");
  describe_clock(visitor, tracker.clock);
  describe_fault(visitor, tracker.frozen, "frozen_at_s", "frozen_s",
                 "Fault: how long the tracker repeats its last pose with new time stamps.");
  describe_fault(
      visitor, tracker.decaying, "decaying_at_s", "decaying_s",
      "Fault: how long the tracker's pose sinks towards the rest pose, half of the way in "
      "0.2 s, at full confidence.");
  describe_fault(visitor, tracker.lost, "lost_at_s", "lost_s",
                 "Fault: how long the tracker gives no samples.");
  describe_fault(visitor, tracker.wrong_finger, "wrong_finger_at_s", "wrong_finger_s",
                 "Fault: how long the tracker exchanges the index and middle fingers.");
  describe_fault(
      visitor, tracker.merged, "merged_at_s", "merged_s",
      "Fault: how long the tracker sees the index and the middle finger as one and gives "
      "both the mean of the two.");
  describe_fault(visitor, tracker.swapped, "swapped_at_s", "swapped_s",
                 "Fault: how long the tracker exchanges the left and right hands.");
}

}  // namespace handcast::config
