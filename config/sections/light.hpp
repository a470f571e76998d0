// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings/field.hpp"

namespace handcast::config {

/// A mirror of the projected picture.
enum class Flip {
  none,
  horizontal,  ///< left and right are exchanged
  vertical,    ///< up and down
  both,        ///< turned by 180 degrees
};
constexpr std::array<std::string_view, 4> words_of(Flip) {
  return {"none", "horizontal", "vertical", "both"};
}

/// What the lamp of the projector is told.
enum class Lamp {
  unchanged,  ///< nothing
  on,         ///< on, with the shutter open
  mute,       ///< on, with the shutter closed
  off,
};
constexpr std::array<std::string_view, 4> words_of(Lamp) {
  return {"unchanged", "on", "mute", "off"};
}

/// [light]
struct Light {
  bool blackout = false;
  bool freeze = false;
  double master = 1;
  double master_s = 0;
  std::vector<std::string> keep_out;
  Flip flip = Flip::none;
  std::vector<double> shift_px{0, 0};
  Lamp lamp = Lamp::unchanged;
};

template <class Visitor>
void describe(Visitor& visitor, Light& light) {
  visitor.field("blackout", light.blackout, "No light at all, from the next frame on.");
  visitor.field("freeze", light.freeze, "The light stays as it is, wherever the hands go.");
  visitor.field("master", light.master, between(0, 1),
                "Share of projector.brightness that is shown.");
  visitor.field("master_s", light.master_s, between(0, 600, "s"),
                "How long `master` takes to a new value.");
  visitor.field("keep_out", light.keep_out,
                "Areas of the projector's picture that stay dark whatever is drawn, e.g. a "
                "painting: polygons of pixels, each \"x y, x y, x y\" with 3 to 32 corners, at "
                "most 16.");
  visitor.field("flip", light.flip,
                "Mirrors the picture, for light that goes over a mirror which the calibration does "
                "not know, or a projection from behind. light.keep_out stays where it is.");
  visitor.field("shift_px", light.shift_px, between(-50, 50, "px"),
                "Moves the drawing in the projector's picture, right and down, against a small "
                "rest of an error. [0, 0] after a calibration.");
  visitor.field("lamp", light.lamp,
                "What the lamp of the projector is told by projector.lamp.pjlink. mute: on, with "
                "the shutter closed. unchanged: nothing.");
}

}  // namespace handcast::config
