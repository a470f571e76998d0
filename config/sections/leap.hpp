// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/settings/field.hpp"

namespace handcast::config {

/// An eye of a stereo camera, as the camera itself looks.
enum class Eye { left, right };
constexpr std::array<std::string_view, 2> words_of(Eye) { return {"left", "right"}; }

/// [camera.leap]
struct Leap {
  std::string device;
  Eye eye = Eye::left;
  bool led_left = true;
  bool led_centre = true;
  bool led_right = true;
  int gain = 16;
  int digital_gain = 0;
  bool gamma = false;
  std::string bring_up;
};

template <class Visitor>
void describe(Visitor& visitor, Leap& leap) {
  visitor.field("device", leap.device,
                "The controller: its serial number, which is printed on it and begins with LP, or "
                "the USB port in which it is plugged, as the log names it (1-2.3). Empty: the only "
                "one that is attached.");
  visitor.field("eye", leap.eye,
                "The eye whose images go to camera.frames; those of the other one go to "
                "camera2.frames.");
  visitor.field("led_left", leap.led_left, "Light the left infrared LED.");
  visitor.field("led_centre", leap.led_centre, "Light the middle one.");
  visitor.field("led_right", leap.led_right, "Light the right one.");
  visitor.field("gain", leap.gain, between(16, 63), "Analogue gain; 16 is the factor 1.");
  visitor.field("digital_gain", leap.digital_gain, between(0, 16), "Digital gain.");
  visitor.field("gamma", leap.gamma,
                "Let the controller send about the square root of the light instead of the light.");
  visitor.field("bring_up", leap.bring_up,
                "File of control transfers that are sent before the stream is started; relative to "
                "the rig file. Empty: those that every controller needs. Firmware before 1.7.1 "
                "needs more; see docs/operating/cameras.md.");
}

}  // namespace handcast::config
