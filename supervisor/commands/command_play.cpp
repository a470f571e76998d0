// SPDX-License-Identifier: Apache-2.0
// `handcast play`: a recorded rig with the recording in place of its sensors.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "config/rig.hpp"
#include "supervisor/commands/verbs.hpp"

namespace handcast::supervisor {
namespace {

namespace fs = std::filesystem;

/// Back ends of camera and tracker that open no device.
constexpr std::array<std::string_view, 5> kWithoutDevice{"", "twin", "replay", "none", "stereo"};

bool has_messages(const fs::path& folder, const std::string& stream) {
  std::error_code error;
  const auto bytes = fs::file_size(folder / (stream + ".index"), error);
  return !error && bytes > 0;
}

/// The settings of a rig in which the streams of the recording in `folder` take the place of its
/// sensors. Nobody knows the true hand of a recording, so there is no score.
Arguments settings_for(const fs::path& folder) {
  Arguments settings{"observer.enabled=false", "watch.enabled=false", "bridge.send=[]",
                     "bridge.receive=[]", "bridge.ros=false"};
  const auto play = [&](const std::string& sensor, const std::string& stream) {
    if (!has_messages(folder, stream)) return false;
    settings.push_back(sensor + ".backend=replay");
    settings.push_back(sensor + ".replay.directory=" + folder.string());
    return true;
  };
  play("camera", "camera.frames");
  play("landmarks", "landmarks.hands");
  const bool has_poses = play("pose", "pose.hands");
  if (has_poses) settings.emplace_back("pose.second=");
  if (play("camera2", "camera2.frames"))
    play("landmarks2", "landmarks2.hands");
  else if (has_poses)
    settings.emplace_back("camera2.backend=none");  // nobody needs it
  return settings;
}

/// A sentence if a sensor of the rig would run beside the recording and nobody has asked for it.
/// Empty also if the rig cannot be read: run_up() says why.
std::string live_device(const fs::path& folder, const fs::path& rig_file,
                        const Arguments& settings) {
  const auto rig = config::load_rig(rig_file, settings);
  if (!rig) return {};
  struct Sensor {
    std::string setting, backend, stream;
  };
  for (const Sensor& sensor : {Sensor{"camera.backend", rig->camera.backend, "camera.frames"},
                               Sensor{"camera2.backend", rig->camera2.backend, "camera2.frames"},
                               Sensor{"pose.backend", rig->pose.backend, "pose.hands"},
                               Sensor{"pose.second", rig->pose.second, "pose.hands"}}) {
    const bool is_asked_for = std::ranges::any_of(settings, [&](const std::string& given) {
      return given.starts_with(sensor.setting + "=");
    });
    if (!is_asked_for && std::ranges::find(kWithoutDevice, sensor.backend) == kWithoutDevice.end())
      return fmt::format(
          "{0} holds no messages of {1}, so the device of the rig ({2} = \"{3}\") would "
          "run; if that is meant, add --set {2}={3}",
          folder.string(), sensor.stream, sensor.setting, sensor.backend);
  }
  return {};
}

}  // namespace

int run_play(const Arguments& arguments) {
  auto line = command_line_of("play");
  std::string recording, out;
  std::vector<std::string> own;
  double seconds = 0;
  line.add("DIR", recording,
           "A folder of `handcast record`; played in a loop, with the rig's settings and "
           "calibration. Streams that were not recorded come from the rig's own sensors");
  line.add("--set path=value", own,
           "As for `handcast up`: projector.backend=file where there is no projector");
  line.add("--seconds N", seconds, "Stops after N seconds", kSomeSeconds);
  line.add("--out DIR", out, "As for `handcast up`");
  if (const auto code = line.answered(arguments)) return *code;
  std::error_code error;
  const auto folder = fs::absolute(recording, error).lexically_normal();
  const auto rig = folder / "rig.toml";
  if (!fs::exists(rig, error))
    return complain(kExitConfig,
                    fmt::format("play: {} is missing: {} is not a folder of `handcast record`; "
                                "other recordings are named in a rig file, as in "
                                "config/rigs/replay.toml",
                                rig.string(), folder.string()));
  auto settings = settings_for(folder);
  settings.insert(settings.end(), own.begin(), own.end());  // after those, so that they count
  if (const auto device = live_device(folder, rig, settings); !device.empty())
    return complain(kExitConfig, "play: " + device);
  Arguments up{rig.string()};
  for (const auto& setting : settings) up.insert(up.end(), {"--set", setting});
  if (seconds > 0) up.push_back(fmt::format("--seconds={}", seconds));
  if (!out.empty()) up.push_back("--out=" + out);
  return run_up(up);
}

}  // namespace handcast::supervisor
