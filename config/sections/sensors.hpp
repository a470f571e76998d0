// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "config/sections/executor.hpp"
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
                "The source of frames; `handcast-camera --backends` lists them.");
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
                "The source of hand poses; `handcast-pose --backends` lists them.");
  visitor.section("replay", pose.replay,
                  "For backend = \"replay\": timestamps.npy with joints_{left,right}.npy and "
                  "bones_{left,right}.npy.");
  visitor.section("process", pose.process, "The process of the service.");
}

/// What the landmarks of `mediapipe` mean.
enum class LandmarkDefinition {
  tracker,  ///< wrist and knuckles moved to where the tracker's joints are
  network,  ///< as the network defines them
};
constexpr std::array<std::string_view, 2> words_of(LandmarkDefinition) {
  return {"tracker", "network"};
}

struct Landmarks {
  std::string backend = "twin";
  Executor executor = Executor::onednn;
  std::string models;
  int hands = 2;
  LandmarkDefinition definition = LandmarkDefinition::tracker;
  Replay replay;
  Process process;
};

template <class Visitor>
void describe(Visitor& visitor, Landmarks& landmarks) {
  visitor.field(
      "backend", landmarks.backend,
      "What finds the 21 landmarks; `handcast-landmarks --backends` lists what this build "
      "has. handcast: handcast's own network, which also reads the tracker's joints and "
      "needs no file from outside. mediapipe: MediaPipe Hands lite. twin: the twin's "
      "model of a detector. replay: a recording.");
  visitor.field("executor", landmarks.executor,
                "handcast, mediapipe: the library that runs the networks. onednn is the faster "
                "one; opencv needs a build with OpenCV's dnn module.");
  visitor.field("models", landmarks.models,
                "handcast, mediapipe: folder of MediaPipe's files, which scripts/get-models "
                "fetches; relative to the rig file. Empty: the folder in HANDCAST_MODELS, else "
                "share/handcast/models of the installation, else ~/.local/share/handcast/models. "
                "mediapipe needs them; handcast uses the palm network, if it is there, to find "
                "hands that the tracker does not see.");
  visitor.field("hands", landmarks.hands, between(1, 2),
                "handcast, mediapipe: the largest number of hands.");
  visitor.field("definition", landmarks.definition,
                "mediapipe: where the landmarks are. network: where the network defines them. "
                "tracker: wrist and knuckles are moved to the tracker's joints, with which the "
                "cascade compares them.");
  visitor.section("replay", landmarks.replay,
                  "For backend = \"replay\": landmarks_{left,right}.npy, (n,21,2) or with sigmas "
                  "(n,21,3), with landmarks_timestamps.npy.");
  visitor.section("process", landmarks.process, "How the service runs.");
}

}  // namespace handcast::config
