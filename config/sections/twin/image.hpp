// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/twin/clock.hpp"
#include "config/sections/twin/fault.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [twin.image]
struct TwinImage {
  double gain = 190;
  double background = 9;
  double noise = 2;
  double sleeve_mm = 110;
  int blur_samples = 2;
  double spread_px = 0;
  double subsurface_mm = 0;
  double texture = 0;
  double clutter = 0;
  double sunlight = 0;
  double table = 0;
  double leak = 0;
  double reflector_mm = 0;
  bool second_person = false;
  double delivery_ms = 0.3;
  double lost = 0;
  double burst = 0;
  TwinClock clock;
  double dark = 1;
  double saturated = 1;
  double holes = 0;
  double covered = 0;
  bool face = false;
  bool object = false;
  /// The time in which dark, saturated, holes, covered, face and object apply.
  Fault fault{0, 1e6};

  bool operator==(const TwinImage&) const = default;
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
  visitor.field("spread_px", image.spread_px, between(0, 10, "px"),
                "Standard deviation of the point spread of lens and sensor.");
  visitor.field("subsurface_mm", image.subsurface_mm, between(0, 20, "mm"),
                "How far light travels under the skin: it softens shades and lights thin parts.");
  visitor.field("texture", image.texture, between(0, 1),
                "Contrast of the skin: creases, veins and nails, as a share of its grey value.");
  visitor.field("clutter", image.clutter, between(0, 1),
                "Brightness of things behind the hand, as a share of the skin's.");
  visitor.field("sunlight", image.sunlight, between(0, 1),
                "Daylight from one side, on hand and background, as a share of the lamp's light.");
  visitor.field(
      "table", image.table, between(0, 1),
      "Reflectance of a glossy table below the hand, which shows a blurred mirror image.");
  visitor.field("leak", image.leak, between(0, 1),
                "Share of the projector's light that passes the camera's filter, relative to the "
                "lamp's light on the skin.");
  visitor.field("reflector_mm", image.reflector_mm, between(0, 30, "mm"),
                "Diameter of a retro-reflector on the tip of each index finger; 0: none.");
  visitor.field("second_person", image.second_person,
                "True: a second person's hand rests at the edge of the image.");
  visitor.field("delivery_ms", image.delivery_ms, between(0, 50, "ms"),
                "Time from the end of the exposure to the frame in memory.");
  visitor.field("lost", image.lost, between(0, 1), "Share of frames that are lost.");
  visitor.field("burst", image.burst, between(0, 1),
                "Share of frames that arrive late, together with the next one.");
  describe_clock(visitor, image.clock);
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
  visitor.field("object", image.object,
                "Fault: the hands hold a bright object, as wide as three fingers.");
  describe_fault(visitor, image.fault, "fault_at_s", "fault_s",
                 "Fault: how long the image has the faults above; by default always.");
}

}  // namespace handcast::config
