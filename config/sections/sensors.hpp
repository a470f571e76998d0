// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/sections/process.hpp"
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

/// [camera]
struct Camera {
  std::string backend = "twin";
  double rate_hz = 525;
  double exposure_ms = 1.85;
  Replay replay;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Camera& camera) {
  visitor.field("backend", camera.backend,
                "The source of frames; `handcast-camera --backends` lists those of this build.");
  visitor.field("rate_hz", camera.rate_hz, between(1, 2000, "Hz"),
                "Frames per second requested from the camera.");
  visitor.field("exposure_ms", camera.exposure_ms, between(0.01, 100, "ms"),
                "Duration of the exposure.");
  visitor.section("replay", camera.replay,
                  "For backend = \"replay\": grey PNG images in camera/ with their times in "
                  "camera_timestamps.npy.");
  visitor.section("process", camera.process, "The process of the service.");
}

/// [pose]
struct Pose {
  std::string backend = "twin";
  Replay replay;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Pose& pose) {
  visitor.field("backend", pose.backend,
                "The source of hand poses; `handcast-pose --backends` lists those of this build.");
  visitor.section("replay", pose.replay,
                  "For backend = \"replay\": timestamps.npy with joints_{left,right}.npy and "
                  "bones_{left,right}.npy.");
  visitor.section("process", pose.process, "The process of the service.");
}

/// How MediaPipe's landmarks are defined.
enum class LandmarkDefinition {
  tracker,  ///< wrist and knuckles moved to where the tracker's joints are
  network,  ///< as the network defines them
};
constexpr std::array<std::string_view, 2> words_of(LandmarkDefinition) {
  return {"tracker", "network"};
}

struct Landmarks {
  std::string backend = "twin";
  std::string models;
  int hands = 2;
  LandmarkDefinition definition = LandmarkDefinition::tracker;
  Replay replay;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Landmarks& landmarks) {
  visitor.field("backend", landmarks.backend,
                "Who finds the 21 landmarks; `handcast-landmarks --backends` lists what this build "
                "has. onednn, opencv: MediaPipe Hands on the "
                "camera's images, run by oneDNN or by OpenCV. own: handcast's own network, which "
                "also looks at the tracker's joints and needs no "
                "file from outside. twin: the twin's model of a detector. replay: recorded ones.");
  visitor.field("models", landmarks.models,
                "onednn, opencv: folder of the networks' files, which scripts/get-models fetches; "
                "relative to the rig file. Empty: the folder "
                "HANDCAST_MODELS names, else share/handcast/models of the installation, else "
                "~/.local/share/handcast/models. own: the palm "
                "network there, if any, finds hands that the tracker does not see.");
  visitor.field("hands", landmarks.hands, between(1, 2),
                "onednn, opencv, own: how many hands are looked for.");
  visitor.field("definition", landmarks.definition,
                "onednn, opencv: network: points as the network defines them. tracker: wrist and "
                "knuckles moved to where the tracker's joints "
                "are defined, which is what the cascade compares them with.");
  visitor.section("replay", landmarks.replay,
                  "For backend = \"replay\": landmarks_{left,right}.npy, (n,21,2) or with sigmas "
                  "(n,21,3), with landmarks_timestamps.npy.");
  visitor.section("process", landmarks.process, "How the service runs.");
}

}  // namespace handcast::config
