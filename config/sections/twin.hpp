// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/settings/field.hpp"

/// The digital twin: a true hand and the errors of the sensors that watch it. Defaults: METHOD's
/// figures, the same for every rig that is compared.
namespace handcast::config {

/// Something goes wrong at one time, for a while: a pure function of the time since the epoch.
struct Fault {
  double at_s = 0;
  double lasting_s = 0;  ///< 0: it never happens

  constexpr bool holds(double seconds) const {
    return seconds >= at_s && seconds < at_s + lasting_s;
  }
};

/// The two settings of a fault, and the sentence that says what it does.
template <class Visitor>
void describe_fault(Visitor& visitor, Fault& fault, std::string_view at_name,
                    std::string_view lasting_name, std::string_view sentence) {
  visitor.field(at_name, fault.at_s, between(0, 1e6, "s"),
                "When the fault of the next setting begins, since the epoch.");
  visitor.field(lasting_name, fault.lasting_s, between(0, 1e6, "s"), sentence);
}

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
  visitor.field("rate_hz", tracker.rate_hz, between(1, 1000, "Hz"), "Samples a second.");
  visitor.field("age_ms", tracker.age_ms, between(0, 500, "ms"),
                "Mean age of a sample when it arrives.");
  visitor.field("age_sd_ms", tracker.age_sd_ms, between(0, 50, "ms"),
                "Standard deviation of that age.");
  visitor.field("scale", tracker.scale, between(0.5, 2),
                "Size of the hand it reports, about the wrist; 1 is true.");
  visitor.field("offset_mm", tracker.offset_mm, between(0, 200, "mm"),
                "How far off the hand is placed, in a direction drawn from the seed.");
  visitor.field("rotation_deg", tracker.rotation_deg, between(0, 45, "deg"),
                "How far it is turned, about an axis drawn from the seed.");
  visitor.field("drift_px", tracker.drift_px, between(0, 100, "px"),
                "Slow drift of every joint at 0.2-1.5 Hz: RMS per axis, in camera pixels at the "
                "hand's distance.");
  visitor.field("noise_mm", tracker.noise_mm, between(0, 50, "mm"),
                "White noise per joint and axis.");
  visitor.field("dropout", tracker.dropout, between(0, 1), "Share of samples that are lost.");
  visitor.field("clock_skew_ms", tracker.clock_skew_ms, between(-200, 200, "ms"),
                "How far off the time stamps are; positive: samples seem younger than they are.");
  describe_fault(visitor, tracker.frozen, "frozen_at_s", "frozen_s",
                 "Fault: how long it repeats its last pose with new time stamps.");
  describe_fault(visitor, tracker.lost, "lost_at_s", "lost_s",
                 "Fault: how long it gives no samples.");
  describe_fault(
      visitor, tracker.wrong_finger, "wrong_finger_at_s", "wrong_finger_s",
      "Fault: how long it takes the index finger for the middle one and the other way round.");
  describe_fault(visitor, tracker.swapped, "swapped_at_s", "swapped_s",
                 "Fault: how long it takes left hands for right ones and right for left.");
}

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
  visitor.field("age_ms", detector.age_ms, between(0, 500, "ms"),
                "Mean time from the middle of an exposure to its landmarks; it runs back to back. "
                "In the simulator it holds for every "
                "landmarks.backend, as do age_sd_ms and clock_skew_ms; the other settings are the "
                "model's alone.");
  visitor.field("age_sd_ms", detector.age_sd_ms, between(0, 50, "ms"),
                "Standard deviation of that time.");
  visitor.field("noise_px", detector.noise_px, between(0, 50, "px"),
                "White noise per landmark and axis.");
  visitor.field("dropout", detector.dropout, between(0, 1),
                "Share of detections that find nothing.");
  visitor.field("outliers", detector.outliers, between(0, 1),
                "Share of landmarks that are thrown 40-200 px off.");
  visitor.field(
      "clock_skew_ms", detector.clock_skew_ms, between(-200, 200, "ms"),
      "How far off the time stamps are; positive: detections seem younger than they are.");
  describe_fault(visitor, detector.lost, "lost_at_s", "lost_s",
                 "Fault: how long it finds nothing.");
  describe_fault(
      visitor, detector.wrong_finger, "wrong_finger_at_s", "wrong_finger_s",
      "Fault: how long it takes the index finger for the middle one and the other way round.");
}

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
  Fault fault{0, 1e6};  ///< when dark, saturated, holes, covered and face hold
};

template <class Visitor>
void describe(Visitor& visitor, TwinImage& image) {
  visitor.field("gain", image.gain, between(1, 2000),
                "Grey value of skin that faces the lamp at the nominal distance.");
  visitor.field("background", image.background, between(0, 255), "Grey value of the empty scene.");
  visitor.field("noise", image.noise, between(0, 50), "Standard deviation of a pixel.");
  visitor.field("sleeve_mm", image.sleeve_mm, between(0, 400, "mm"),
                "Where the bright sleeve begins, from the wrist towards the elbow.");
  visitor.field("blur_samples", image.blur_samples, between(1, 16),
                "Instants of the exposure that are averaged.");
  visitor.field("delivery_ms", image.delivery_ms, between(0, 50, "ms"),
                "From the end of the exposure to the frame in memory.");
  visitor.field("dark", image.dark, between(0, 1),
                "Fault: too little light. Grey values times this; 1 is none.");
  visitor.field("saturated", image.saturated, between(1, 100),
                "Fault: too much light. Grey values times this, up to white; 1 is none.");
  visitor.field("holes", image.holes, between(0, 0.9),
                "Fault: share of each hand's surface under dark blobs that move with it.");
  visitor.field("covered", image.covered, between(0, 1),
                "Fault: share of the image, from its left edge, behind something dark; 0.5 hides "
                "half of a hand in the middle.");
  visitor.field("face", image.face, "Fault: a face looks on from behind the hands.");
  describe_fault(visitor, image.fault, "fault_at_s", "fault_s",
                 "How long the image has the faults above; all the time unless set.");
}

struct TwinShape {
  double length_spread = 0.04;
  double width_spread = 0.06;
};

template <class Visitor>
void describe(Visitor& visitor, TwinShape& shape) {
  visitor.field("length_spread", shape.length_spread, between(0, 0.2),
                "How far a true bone length may be from the model's (share, drawn from the seed).");
  visitor.field("width_spread", shape.width_spread, between(0, 0.3), "The same for widths.");
}

/// Which of the motion's hands there are.
enum class TwinHands {
  both,
  left,
  right,
};
constexpr std::array<std::string_view, 3> words_of(TwinHands) { return {"both", "left", "right"}; }

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
                "The true motion: builtin:open_close, wave, rotate, pinch, shake, two_hands, "
                "still, crossing, flip, fist, point_at_camera, "
                "enter_leave, reverse, cross_fingers; or a folder with a recording.");
  visitor.field("hands", twin.hands, "Which of the motion's hands are there.");
  visitor.field("speed", twin.speed, between(0.01, 20), "Plays the motion faster or slower.");
  visitor.field("seed", twin.seed, between(0, 1e9), "Everything random is drawn from this number.");
  visitor.section("shape", twin.shape, "How the true hand differs from the model.");
  visitor.section("tracker", twin.tracker, "The errors of the hand tracker.");
  visitor.section("detector", twin.detector, "The errors of the landmark detector.");
  visitor.section("image", twin.image, "The look of the camera images.");
}

}  // namespace handcast::config
