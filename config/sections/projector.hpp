// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/sections/process.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// The back end that draws the frames.
enum class PainterChoice {
  cpu,        ///< one core of the processor
  gl,         ///< a GPU, by OpenGL
  automatic,  ///< the faster one
};
constexpr std::array<std::string_view, 3> words_of(PainterChoice) { return {"cpu", "gl", "auto"}; }

/// The sub-frames that share one output frame, for a projector that shows them one after the other.
enum class Packing {
  none,          ///< an output frame is one frame
  planes_24x1,   ///< 24 frames of 1 bit, one per bit of RGB8
  planes_8x3,    ///< 8 frames of 1 bit per colour
  quadrants_4,   ///< 4 colour frames of half the width and height
  quadrants_12,  ///< 12 grey frames of half the width and height
};
constexpr std::array<std::string_view, 5> words_of(Packing) {
  return {"none", "24x1", "8x3", "quadrants_rgb", "quadrants_grey"};
}

/// [projector.file]
struct ProjectorFile {
  std::string folder = "light";
  bool film = false;
  int every = 100;
};

template <class Visitor>
void describe(Visitor& visitor, ProjectorFile& file) {
  visitor.field("folder", file.folder,
                "The folder for the files, relative to that of `up --out`, or else to the current "
                "one.");
  visitor.field("film", file.film, "Writes one film, light.avi, instead of pictures.");
  visitor.field("every", file.every, between(1, 100000), "Every n-th frame is written.");
}

/// [projector.kms]
struct ProjectorKms {
  std::string card;
  std::string connector;
  std::string mode;
};

template <class Visitor>
void describe(Visitor& visitor, ProjectorKms& kms) {
  visitor.field("card", kms.card,
                "The device of the graphics card: /dev/dri/card0. Empty: the first one with the "
                "connector.");
  visitor.field(
      "connector", kms.connector,
      "The projector: its connector (HDMI-A-1) or the model in its EDID; a name that does "
      "not exist gets a list of them. Empty: the only one that is connected.");
  visitor.field("mode", kms.mode,
                "WIDTHxHEIGHT or WIDTHxHEIGHT@HZ. Empty: the projector's size at the rate next to "
                "rate_hz.");
}

/// [projector.window]
struct ProjectorWindow {
  std::string monitor;
  bool full_screen = true;
  bool vsync = true;
};

template <class Visitor>
void describe(Visitor& visitor, ProjectorWindow& window) {
  visitor.field(
      "monitor", window.monitor,
      "The monitor or projector: its output (HDMI-1), the model in its EDID, or an index; a "
      "name that does not exist gets a list of them. Empty: the only one besides the "
      "primary one.");
  visitor.field("full_screen", window.full_screen,
                "Covers the monitor, in its current video mode. Off: a window among others, to try "
                "a rig.");
  visitor.field("vsync", window.vsync,
                "Frames change between two refreshes. Off: the light comes up to a refresh sooner, "
                "but the picture may be torn.");
}

/// [projector.lamp]
struct ProjectorLamp {
  std::string pjlink;
  std::string password_file;
  std::string input;
};

template <class Visitor>
void describe(Visitor& visitor, ProjectorLamp& lamp) {
  visitor.field("pjlink", lamp.pjlink,
                "Where the projector takes commands by PJLink: HOST or HOST:PORT. Empty: nowhere.");
  visitor.field("password_file", lamp.password_file,
                "A file with the password of PJLink in its first line, which only this user can "
                "read. Empty: that of the environment variable HANDCAST_PJLINK_PASSWORD, if any.");
  visitor.field(
      "input", lamp.input,
      "The input that is chosen when the lamp is turned on, in PJLink's two digits: 31 is "
      "the first digital one. Empty: it is left alone.");
}

/// [projector]
struct Projector {
  std::string backend = "twin";
  PainterChoice painter = PainterChoice::cpu;
  int painter_threads = 1;
  double rate_hz = 946;
  double latency_ms = 3.0;
  double software_ms = 1.2;
  double frame_wait_ms = 0;
  double brightness = 1;
  double gamma = 0;
  double fade_s = 0.5;
  Packing packing = Packing::none;
  bool dither = true;
  ProjectorFile file;
  ProjectorKms kms;
  ProjectorWindow window;
  ProjectorLamp lamp;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Projector& projector) {
  visitor.field("backend", projector.backend,
                "The output device; `handcast-projector --backends` lists them.");
  visitor.field("painter", projector.painter,
                "What draws the frames. cpu: one core. gl: a GPU, by OpenGL 4.5 and EGL, without a "
                "window; cpu, if it cannot be opened or is lost. auto: both are measured at "
                "each start of the projector, for at most 0.3 s, and the faster one draws. The "
                "simulator always draws with cpu.");
  visitor.field("painter_threads", projector.painter_threads, between(1, 8),
                "Threads on which the painter cpu draws. More make a frame shorter where the "
                "projector has as many cores to itself, and take that time from other services "
                "where it has not.");
  visitor.field("rate_hz", projector.rate_hz, between(1, 10000, "Hz"),
                "Frames per second requested from the projector.");
  visitor.field("latency_ms", projector.latency_ms, between(0, 200, "ms"),
                "Time from handing over a frame to the start of its light.");
  visitor.field(
      "software_ms", projector.software_ms, between(0, 100, "ms"),
      "Time from the newest inputs to the frame handed over. The simulator assumes it for each "
      "frame, a live rig only for the first frames, until it has measured the time.");
  visitor.field(
      "frame_wait_ms", projector.frame_wait_ms, between(0, 100, "ms"),
      "How long a projector frame may wait for a newer camera image. 0: it does not wait.",
      Effect::live);
  visitor.field("brightness", projector.brightness, between(0, 1),
                "Factor of the light, a limit for people's eyes. 1: all of it.", Effect::live);
  visitor.field("gamma", projector.gamma, between(0, 5),
                "The projector turns a level 0..1 into the light level^gamma. 0: as in sRGB, the "
                "encoding of pictures.",
                Effect::live);
  visitor.field("fade_s", projector.fade_s, between(0, 10, "s"),
                "How long the light of a rig takes to full brightness at its start, and to black "
                "at its stop, then at most half of supervisor.stop_s. A projector that replaces "
                "another one does not fade.",
                Effect::live);
  visitor.field(
      "packing", projector.packing,
      "The sub-frames in an output frame, for a projector that shows them one after the "
      "other; each is drawn for the time of its own light, and rate_hz counts them. none: "
      "one frame. 24x1: 24 frames of 1 bit. 8x3: 8 frames of 1 bit per colour. "
      "quadrants_rgb: 4 frames of half the width and height. quadrants_grey: 12 of them, "
      "without colour.");
  visitor.field(
      "dither", projector.dither,
      "24x1, 8x3: a level between black and white becomes a pattern of both, which "
      "changes from sub-frame to sub-frame. Off: levels of at least half the light become "
      "white.");
  visitor.section("file", projector.file, "The back end `file`.");
  visitor.section("kms", projector.kms, "The back end `kms`.");
  visitor.section("window", projector.window, "The back end `window`.");
  visitor.section("lamp", projector.lamp, "The projector's lamp and shutter, over the network.");
  visitor.section("process", projector.process, "The process of the service.");
}

/// [projector2]
struct SecondProjector : Projector {
  SecondProjector() {
    backend = "none";
    file.folder = "light2";
  }
  std::string calibration;
};

template <class Visitor>
void describe(Visitor& visitor, SecondProjector& projector) {
  visitor.field("calibration", projector.calibration,
                "The calibration file of a rig with the same camera and this projector, of which "
                "its [projector] is used.");
  describe(visitor, static_cast<Projector&>(projector));
}

/// [hand]
struct Hand {
  std::string left;
  std::string right;
};

template <class Visitor>
void describe(Visitor& visitor, Hand& hand) {
  visitor.field("left", hand.left,
                "The model that is drawn as the left hand: a skinned glTF file with WebXR joint "
                "names. Empty: the hand of handcast.");
  visitor.field("right", hand.right, "The same for the right hand.");
}

}  // namespace handcast::config
