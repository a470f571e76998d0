// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "config/sections/drift.hpp"
#include "config/sections/external.hpp"
#include "config/sections/handover.hpp"
#include "config/sections/leap.hpp"
#include "config/sections/leapc.hpp"
#include "config/sections/openxr.hpp"
#include "config/sections/process.hpp"
#include "config/sections/stereo.hpp"
#include "config/settings/field.hpp"

namespace handcast::config {

/// [SENSOR.replay]
struct Replay {
  std::string directory;
  bool loop = true;
};

template <class Visitor>
void describe(Visitor& visitor, Replay& replay) {
  visitor.field("directory", replay.directory,
                "Folder of the recording; relative to the rig file.");
  visitor.field("loop", replay.loop, "Start again at the end of the recording.");
}

/// When the images of a recording are delivered.
enum class Pace {
  recorded,  ///< at the times at which they were taken
  fastest,   ///< each as soon as the one before it was taken
};
constexpr std::array<std::string_view, 2> words_of(Pace) { return {"recorded", "fastest"}; }

/// [camera.replay]
struct CameraReplay {
  std::string directory;
  bool loop = true;
  Pace pace = Pace::recorded;
};

template <class Visitor>
void describe(Visitor& visitor, CameraReplay& replay) {
  visitor.field("directory", replay.directory,
                "The recording: a folder that `handcast record` has written, a folder of PNG "
                "images, a film, or a .npy file; relative to the rig file.");
  visitor.field("loop", replay.loop, "Start again at the end of the recording.");
  visitor.field("pace", replay.pace,
                "recorded: images come at the times at which they were taken. fastest: each one "
                "comes as soon as the one before it has been delivered.");
}

/// How a GenICam camera sends its pixels.
enum class PixelFormat {
  mono8,
  mono10,
  mono10_p,       ///< a string of bits
  mono10_packed,  ///< GigE Vision: two pixels in three bytes
  mono12,
  mono12_p,       ///< a string of bits
  mono12_packed,  ///< GigE Vision: two pixels in three bytes
};
constexpr std::array<std::string_view, 7> words_of(PixelFormat) {
  return {"Mono8", "Mono10", "Mono10p", "Mono10Packed", "Mono12", "Mono12p", "Mono12Packed"};
}

/// What starts an exposure.
enum class Trigger {
  free_run,  ///< the camera's own clock, at rate_hz
  line,      ///< a hardware line
  software,  ///< a command of the service, at rate_hz
};
constexpr std::array<std::string_view, 3> words_of(Trigger) {
  return {"free_run", "line", "software"};
}

/// [camera.aravis]
struct Aravis {
  std::string device;
  int offset_x_px = 0;
  int offset_y_px = 0;
  int binning = 1;
  PixelFormat format = PixelFormat::mono8;
  double gain_db = 0;
  Trigger trigger = Trigger::free_run;
  std::string trigger_line = "Line1";
  std::string exposure_line;
  int packet_bytes = 0;
  double packet_delay_us = 0;
  std::vector<std::string> features;
};

template <class Visitor>
void describe(Visitor& visitor, Aravis& aravis) {
  visitor.field("device", aravis.device,
                "The camera: its serial number, name or address, as `handcast devices` lists it. "
                "Empty: the only one that is attached.");
  visitor.field("offset_x_px", aravis.offset_x_px, between(0, 65535, "px"),
                "The left end of the region of the sensor that is read. Its size is that of the "
                "calibration.");
  visitor.field("offset_y_px", aravis.offset_y_px, between(0, 65535, "px"), "Its upper end.");
  visitor.field("binning", aravis.binning, between(1, 8),
                "So many columns and rows of the sensor become one pixel.");
  visitor.field("format", aravis.format,
                "How the camera sends a pixel. The 8 highest bits are used. Mono8 needs the fewest "
                "bytes; the others are for cameras without it.");
  visitor.field("gain_db", aravis.gain_db, between(0, 60, "dB"), "Analogue gain.");
  visitor.field("trigger", aravis.trigger,
                "What starts an exposure. free_run: the camera's clock. line: trigger_line. "
                "software: a command of the service. The last two: rate_hz is what is expected.");
  visitor.field("trigger_line", aravis.trigger_line, "The input of the hardware trigger.");
  visitor.field("exposure_line", aravis.exposure_line,
                "The output that is active during the exposure, for infrared lamps. Empty: none.");
  visitor.field("packet_bytes", aravis.packet_bytes, between(0, 65535, "B"),
                "GigE: size of a packet. 0: the largest one that reaches this computer.");
  visitor.field("packet_delay_us", aravis.packet_delay_us, between(0, 100000, "us"),
                "GigE: pause after each packet, if several cameras share a link.");
  visitor.field("features", aravis.features,
                "Further GenICam features, in their order: [\"GammaEnable=false\", "
                "\"BlackLevel=4\"].");
}

/// How a webcam sends its pixels.
enum class WebcamFormat { automatic, grey, y10, y16, yuyv, nv12, mjpeg };
constexpr std::array<std::string_view, 7> words_of(WebcamFormat) {
  return {"auto", "GREY", "Y10", "Y16", "YUYV", "NV12", "MJPEG"};
}

/// [camera.v4l2]
struct V4l2 {
  std::string device;
  WebcamFormat format = WebcamFormat::automatic;
  std::vector<std::string> controls;
};

template <class Visitor>
void describe(Visitor& visitor, V4l2& v4l2) {
  visitor.field("device", v4l2.device,
                "The camera: /dev/video0, or its name or bus, as `handcast devices` lists them. "
                "Empty: the only one that is attached.");
  visitor.field("format", v4l2.format,
                "How the camera sends its pixels. auto: the first of GREY, Y16, Y10, NV12, YUYV "
                "and MJPEG that it has in the size of the calibration.");
  visitor.field("controls", v4l2.controls,
                "Further controls, in their order, by the names of the kernel: "
                "[\"power_line_frequency=0\", \"gain=20\"].");
}

/// [camera]
struct Camera {
  std::string backend = "twin";
  double rate_hz = 525;
  double exposure_ms = 1.85;
  double delivery_ms = 0;
  Aravis aravis;
  V4l2 v4l2;
  Leap leap;
  CameraReplay replay;
  External external;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Camera& camera) {
  visitor.field("backend", camera.backend,
                "The source of frames; `handcast-camera --backends` lists them.");
  visitor.field("rate_hz", camera.rate_hz, between(1, 2000, "Hz"),
                "Frames per second requested from the camera.");
  visitor.field("exposure_ms", camera.exposure_ms, between(0.01, 100, "ms"),
                "Duration of the exposure.");
  visitor.field("delivery_ms", camera.delivery_ms, between(0, 100, "ms"),
                "aravis, v4l2: the least time from the end of an exposure until its image has "
                "arrived: readout and transfer. leap: until its first bytes are sent.");
  visitor.section("aravis", camera.aravis,
                  "For backend = \"aravis\": a GigE Vision or USB3 Vision camera.");
  visitor.section("v4l2", camera.v4l2, "For backend = \"v4l2\": a webcam.");
  visitor.section("leap", camera.leap,
                  "For backend = \"leap\": a Leap Motion Controller, read over USB.");
  visitor.section("replay", camera.replay, "For backend = \"replay\".");
  visitor.section("external", camera.external, kOfExternal);
  visitor.section("process", camera.process, "The process of the service.");
}

/// [pose.none]
struct PoseNone {
  double distance_m = 0.73;
  double hand_length_mm = 0;
};

template <class Visitor>
void describe(Visitor& visitor, PoseNone& none) {
  visitor.field("distance_m", none.distance_m, between(0.1, 10, "m"),
                "Distance of the hand from the camera.");
  visitor.field(
      "hand_length_mm", none.hand_length_mm, between(0, 300, "mm"),
      "From the wrist to the tip of the middle finger. 0: the length of handcast's hand.");
}

/// [pose]
struct Pose {
  std::string backend = "twin";
  std::string second;
  Handover handover;
  Leapc leapc;
  PoseNone none;
  OpenXr openxr;
  PoseStereo stereo;
  Replay replay;
  External external;
  Drift drift;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Pose& pose) {
  visitor.field("backend", pose.backend,
                "The source of hand poses; `handcast-pose --backends` lists them.");
  visitor.field("second", pose.second,
                "A second source, another back end, which takes over while the first one sees no "
                "hand. Empty: none.");
  visitor.section("handover", pose.handover, "Two sources: when one takes over from the other.");
  visitor.section("leapc", pose.leapc, "For backend = \"leapc\": Ultraleap's service.");
  visitor.section("none", pose.none,
                  "For backend = \"none\": a rig without a tracker. The landmarks are lifted to "
                  "the distance of the hand.");
  visitor.section("openxr", pose.openxr,
                  "For backend = \"openxr\": the hand tracker of an OpenXR runtime.");
  visitor.section(
      "stereo", pose.stereo,
      "For backend = \"stereo\": the hands of two calibrated cameras, from the landmarks "
      "of both.");
  visitor.section("replay", pose.replay,
                  "For backend = \"replay\": timestamps.npy with joints_{left,right}.npy and "
                  "bones_{left,right}.npy.");
  visitor.section("external", pose.external, kOfExternal);
  visitor.section("drift", pose.drift,
                  "The watch over the calibration: has the tracker moved against the camera?");
  visitor.section("process", pose.process, "The process of the service.");
}

/// [landmarks]
struct Landmarks {
  std::string backend = "twin";
  std::string fallback;
  std::string models;
  int hands = 2;
  Replay replay;
  External external;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Landmarks& landmarks) {
  visitor.field(
      "backend", landmarks.backend,
      "What finds the 21 landmarks; `handcast-landmarks --backends` lists what this build "
      "has. handcast: handcast's own network, which also reads the tracker's joints and "
      "needs no file from outside. mediapipe: MediaPipe Hands lite. twin: the twin's "
      "model of a detector. replay: a recording. external: a program of your own.");
  visitor.field("fallback", landmarks.fallback,
                "The back end that takes the place of `backend` if a file of its networks is "
                "missing; a line of the log says so. Empty: a missing file is an error.");
  visitor.field("models", landmarks.models,
                "handcast, mediapipe: folder of MediaPipe's files, which scripts/get-models "
                "fetches; relative to the rig file. Empty: the folder in HANDCAST_MODELS, else "
                "share/handcast/models of the installation, else ~/.local/share/handcast/models. "
                "mediapipe needs them; handcast uses the palm network, if it is there, to find "
                "hands that the tracker does not see.");
  visitor.field("hands", landmarks.hands, between(1, 2),
                "handcast, mediapipe: the largest number of hands.");
  visitor.section("replay", landmarks.replay,
                  "For backend = \"replay\": landmarks_{left,right}.npy, (n,21,2) or with sigmas "
                  "(n,21,3), with landmarks_timestamps.npy.");
  visitor.section("external", landmarks.external, kOfExternal);
  visitor.section("process", landmarks.process, "How the service runs.");
}

}  // namespace handcast::config
