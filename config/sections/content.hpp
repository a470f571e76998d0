// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [content]
struct Content {
  std::string left = "builtin:atlas";
  std::string right = "builtin:atlas";
  std::string transition = "fade";
  double transition_s = 0.6;
  double rate_hz = 60;
  int width_px = 640;
  int height_px = 400;
  std::string sound = "default";
  double shading = 0.0;
  bool smooth = true;
  std::vector<double> gravity{0, 1, 0};
  Process process{.wait = ipc::Wait::futex};
};

template <class Visitor>
void describe(Visitor& visitor, Content& content) {
  visitor.field(
      "left", content.left,
      "What is on the left hand: a look (handcast content lists them), a PNG or JPEG file in the "
      "layout that `handcast template` writes, builtin:atlas, builtin:checker, builtin:skeleton, "
      "builtin:white, or sources and filters, e.g. \"film:a.mp4 speed=0.5 | isf:glow.fs\".",
      Effect::live);
  visitor.field("right", content.right, "The same for the right hand.", Effect::live);
  visitor.field("transition", content.transition,
                "How one content becomes another: cut, fade, or an ISF transition, e.g. "
                "\"isf:wipe.fs\".",
                Effect::live);
  visitor.field("transition_s", content.transition_s, between(0, 60, "s"), "How long that takes.",
                Effect::live);
  visitor.field("rate_hz", content.rate_hz, between(1, 240, "Hz"),
                "Pictures per second of content that moves.");
  visitor.field("width_px", content.width_px, between(128, 2048, "px"),
                "Width of the pictures of the content service; `handcast template` has the "
                "proportions 8:5.");
  visitor.field("height_px", content.height_px, between(128, 2048, "px"),
                "Height of the pictures.");
  visitor.field("sound", content.sound,
                "The sound device that shaders with an input of sound hear, by its ALSA name "
                "(`arecord -L` lists them); PipeWire and PulseAudio are \"default\".");
  visitor.field(
      "shading", content.shading, between(0, 1),
      "Strength of the shading by a light that shines along the camera's axis. 0: no shading.",
      Effect::live);
  visitor.field(
      "smooth", content.smooth,
      "Pictures are filtered, and pixels on an edge are lit in part. Off: saves some time "
      "in each frame, but fine lines break up and edges have steps.");
  visitor.field("gravity", content.gravity, between(-1, 1),
                "Down, for content that reacts to it: a direction in the space of the camera, x to "
                "the right in its image, y down, z away from it. [0, 0, 1] for a camera that looks "
                "down from above.",
                Effect::live);
  visitor.section("process", content.process, "The process of the service.");
}

}  // namespace handcast::config
