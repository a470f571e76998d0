// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// What a DLP projector makes of its video input.
enum class DlpMode {
  video,    ///< an ordinary picture
  pattern,  ///< the bit planes of projector.packing, one after the other
};
constexpr std::array<std::string_view, 2> words_of(DlpMode) { return {"video", "pattern"}; }

/// The signal that a LED driver understands as its full current.
enum class LedSignal {
  automatic,  ///< as the controller's board has it
  direct,     ///< the full signal
  inverted,   ///< no signal
};
constexpr std::array<std::string_view, 3> words_of(LedSignal) {
  return {"auto", "direct", "inverted"};
}

/// [dlp]
struct Dlp {
  std::string backend = "none";
  std::string device;
  DlpMode mode = DlpMode::video;
  LedSignal signal = LedSignal::automatic;
  double limit = 0.5;
  double red = 0.3;
  double green = 0.3;
  double blue = 0.3;
  bool trigger_in = false;
  bool trigger_out = false;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Dlp& dlp) {
  visitor.field(
      "backend", dlp.backend,
      "What commands the projector; `handcast-dlp --backends` lists them. none: nothing.");
  visitor.field("device", dlp.device,
                "Its serial number or path, as `handcast devices` lists them. Empty: the only one "
                "that is attached.");
  visitor.field("mode", dlp.mode,
                "video: an ordinary picture. pattern: the sub-frames of projector.packing, 24x1 or "
                "8x3, one after the other.");
  visitor.field("signal", dlp.signal,
                "What the LED drivers take for the full current: direct, the full signal; "
                "inverted, none. auto: inverted with the DLPC350, as on the LightCrafter 4500, and "
                "direct with the DLPC900. If this is wrong for your board, limit does not limit.");
  visitor.field("limit", dlp.limit, between(0, 1),
                "The largest current of a LED that is ever commanded, as a share of the "
                "controller's full scale. What the LEDs and the cooling allow is in their data "
                "sheet.");
  visitor.field("red", dlp.red, between(0, 1),
                "Current of the red LED, as a share of the full scale; at most limit.");
  visitor.field("green", dlp.green, between(0, 1), "Of the green LED.");
  visitor.field("blue", dlp.blue, between(0, 1), "Of the blue LED.");
  visitor.field("trigger_in", dlp.trigger_in,
                "pattern: sub-frames follow an external trigger instead of the vertical sync.");
  visitor.field("trigger_out", dlp.trigger_out,
                "A pulse at each sub-frame on trigger output 1, and at each frame on output 2.");
  visitor.section("process", dlp.process, "The process of the service.");
}

}  // namespace handcast::config
