// SPDX-License-Identifier: Apache-2.0
// `handcast play`: a recorded rig with the recording in place of its sensors.
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "supervisor/base/options.hpp"
#include "supervisor/commands/verbs.hpp"

namespace handcast::supervisor {
namespace {

namespace fs = std::filesystem;

bool has_messages(const fs::path& folder, const std::string& stream) {
  std::error_code error;
  const auto bytes = fs::file_size(folder / (stream + ".index"), error);
  return !error && bytes > 0;
}

/// The settings of a rig in which the streams of the recording in `folder` take the place of its
/// sensors. Nobody knows the true hand of a recording, so there is no score.
Arguments settings_for(const fs::path& folder) {
  Arguments settings{"observer.enabled=false"};
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

}  // namespace

int run_play(const Arguments& arguments) {
  const auto options = sort_options(
      arguments, {.with_value = {"--set", "--seconds", "--out"}, .flags = {}, .words = {"DIR"}});
  if (!options)
    return complain(kExitUsage, "play: " + options.error().what + "; `handcast help play`");
  std::error_code error;
  const auto folder = fs::absolute(options->words.front(), error).lexically_normal();
  const auto rig = folder / "rig.toml";
  if (!fs::exists(rig, error))
    return complain(kExitConfig,
                    fmt::format("play: {} is missing: {} is not a folder of `handcast record`; "
                                "other recordings are named in a rig file, as in "
                                "config/rigs/replay.toml",
                                rig.string(), folder.string()));
  Arguments up{rig.string()};
  for (const auto& setting : settings_for(folder)) up.insert(up.end(), {"--set", setting});
  // After those, so that the user's count.
  for (const auto* option : {"--set", "--seconds", "--out"})
    for (const auto& value : options->all(option)) up.insert(up.end(), {option, value});
  return run_up(up);
}

}  // namespace handcast::supervisor
