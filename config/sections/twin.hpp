// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/settings/field.hpp"

/// The digital twin: a true hand, and the errors of the sensors that observe it. The defaults are
/// the figures of docs/method.md#twin, the same for all rigs that are compared.
namespace handcast::config {

/// A fault that begins at one time and lasts for a while. Times are since the epoch of the rig, at
/// which the twin's motion starts.
struct Fault {
  double at_s = 0;       ///< when it begins
  double lasting_s = 0;  ///< how long it lasts; 0: it never happens

  /// True if the fault is present at this time.
  constexpr bool holds(double seconds) const {
    return seconds >= at_s && seconds < at_s + lasting_s;
  }
};

/// Declares the two settings of a fault; `sentence` describes its effect.
template <class Visitor>
void describe_fault(Visitor& visitor, Fault& fault, std::string_view at_name,
                    std::string_view lasting_name, std::string_view sentence) {
  visitor.field(at_name, fault.at_s, between(0, 1e6, "s"),
                "Fault: its begin, since the start of the rig; the next setting says what it is.");
  visitor.field(lasting_name, fault.lasting_s, between(0, 1e6, "s"), sentence);
}

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
  double clock_skew_ms = 0;
  Fault frozen, lost, wrong_finger, swapped;
};

template <class Visitor>
void describe(Visitor& visitor, TwinTracker& tracker) {
  visitor.field("rate_hz", tracker.rate_hz, between(1, 1000, "Hz"), "Samples per second.");
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
  visitor.field("dropout", tracker.dropout, between(0, 1), "Share of samples that are lost.");
  visitor.field("clock_skew_ms", tracker.clock_skew_ms, between(-200, 200, "ms"),
                "Error of the time stamps; positive: samples seem younger than they are.");
  describe_fault(visitor, tracker.frozen, "frozen_at_s", "frozen_s",
                 "Fault: how long the tracker repeats its last pose with new time stamps.");
  describe_fault(visitor, tracker.lost, "lost_at_s", "lost_s",
                 "Fault: how long the tracker gives no samples.");
  describe_fault(visitor, tracker.wrong_finger, "wrong_finger_at_s", "wrong_finger_s",
                 "Fault: how long the tracker exchanges the index and middle fingers.");
  describe_fault(visitor, tracker.swapped, "swapped_at_s", "swapped_s",
                 "Fault: how long the tracker exchanges the left and right hands.");
}

/// [twin.detector]
struct TwinDetector {
  double age_ms = 16.2;
  double age_sd_ms = 1.9;
  double noise_px = 1;
  double dropout = 0;
  double outliers = 0;
  double clock_skew_ms = 0;
  Fault lost, wrong_finger;
};

template <class Visitor>
void describe(Visitor& visitor, TwinDetector& detector) {
  visitor.field(
      "age_ms", detector.age_ms, between(0, 500, "ms"),
      "Mean time from the middle of an exposure to its landmarks; one detection follows the other "
      "without a pause. In the simulator, age_ms, age_sd_ms and clock_skew_ms apply to every "
      "landmarks.backend, the other settings only to the twin's model of a detector.");
  visitor.field("age_sd_ms", detector.age_sd_ms, between(0, 50, "ms"),
                "Standard deviation of that time.");
  visitor.field("noise_px", detector.noise_px, between(0, 50, "px"),
                "White noise per landmark and axis.");
  visitor.field("dropout", detector.dropout, between(0, 1),
                "Share of detections that find nothing.");
  visitor.field("outliers", detector.outliers, between(0, 1),
                "Share of landmarks that are displaced by 40-200 px.");
  visitor.field("clock_skew_ms", detector.clock_skew_ms, between(-200, 200, "ms"),
                "Error of the time stamps; positive: detections seem younger than they are.");
  describe_fault(visitor, detector.lost, "lost_at_s", "lost_s",
                 "Fault: how long the detector finds nothing.");
  describe_fault(visitor, detector.wrong_finger, "wrong_finger_at_s", "wrong_finger_s",
                 "Fault: how long the detector exchanges the index and middle fingers.");
}

/// [twin.image]
struct TwinImage {
  double gain = 190;
  double background = 9;
  double noise = 2;
  double sleeve_mm = 110;
  int blur_samples = 2;
  double delivery_ms = 0.3;
  double dark = 1;
  double saturated = 1;
  double holes = 0;
  double covered = 0;
  bool face = false;
  Fault fault{0, 1e6};  ///< the time in which dark, saturated, holes, covered and face apply
};

template <class Visitor>
void describe(Visitor& visitor, TwinImage& image) {
  visitor.field("gain", image.gain, between(1, 2000),
                "Grey value of skin that faces the lamp at the nominal distance.");
  visitor.field("background", image.background, between(0, 255), "Grey value of the empty scene.");
  visitor.field("noise", image.noise, between(0, 50),
                "Standard deviation of the noise of a pixel.");
  visitor.field("sleeve_mm", image.sleeve_mm, between(0, 400, "mm"),
                "Where the bright sleeve begins, from the wrist towards the elbow.");
  visitor.field("blur_samples", image.blur_samples, between(1, 16),
                "Number of instants of the exposure that are averaged for motion blur.");
  visitor.field("delivery_ms", image.delivery_ms, between(0, 50, "ms"),
                "Time from the end of the exposure to the frame in memory.");
  visitor.field("dark", image.dark, between(0, 1),
                "Fault: too little light. Factor of the grey values; 1: no fault.");
  visitor.field("saturated", image.saturated, between(1, 100),
                "Fault: too much light. Factor of the grey values, up to white; 1: no fault.");
  visitor.field("holes", image.holes, between(0, 0.9),
                "Fault: share of the surface of each hand that is covered by dark blobs, which "
                "move with it.");
  visitor.field("covered", image.covered, between(0, 1),
                "Fault: share of the image, from its left edge, that is hidden by a dark object; "
                "0.5 hides half of a hand in the middle.");
  visitor.field("face", image.face, "Fault: a face is visible behind the hands.");
  describe_fault(visitor, image.fault, "fault_at_s", "fault_s",
                 "Fault: how long the image has the faults above; by default always.");
}

/// [twin.shape]
struct TwinShape {
  double length_spread = 0.04;
  double width_spread = 0.06;
};

template <class Visitor>
void describe(Visitor& visitor, TwinShape& shape) {
  visitor.field(
      "length_spread", shape.length_spread, between(0, 0.2),
      "Largest deviation of a true bone length from the model, as a share; drawn from the seed.");
  visitor.field("width_spread", shape.width_spread, between(0, 0.3),
                "The same for the width of the hand and its fingers.");
}

/// The hands of the motion that exist in the twin.
enum class TwinHands {
  both,
  left,
  right,
};
constexpr std::array<std::string_view, 3> words_of(TwinHands) { return {"both", "left", "right"}; }

/// [twin]
struct Twin {
  std::string motion = "builtin:open_close";
  TwinHands hands = TwinHands::both;
  double speed = 1;
  int seed = 1;
  TwinShape shape;
  TwinTracker tracker;
  TwinDetector detector;
  TwinImage image;
};

template <class Visitor>
void describe(Visitor& visitor, Twin& twin) {
  visitor.field("motion", twin.motion,
                "The true motion: builtin:show, open_close, wave, rotate, pinch, shake, two_hands, "
                "still, crossing, flip, fist, point_at_camera, enter_leave, reverse, "
                "cross_fingers; or a folder with a recording.");
  visitor.field("hands", twin.hands, "The hands of the motion that exist in the twin.");
  visitor.field("speed", twin.speed, between(0.01, 20), "Speed of the motion; 1: unchanged.");
  visitor.field("seed", twin.seed, between(0, 1e9), "The seed of all random numbers.");
  visitor.section("shape", twin.shape, "The differences of the true hand from the model.");
  visitor.section("tracker", twin.tracker, "The errors of the hand tracker.");
  visitor.section("detector", twin.detector, "The errors of the landmark detector.");
  visitor.section("image", twin.image, "The camera images.");
}

}  // namespace handcast::config
