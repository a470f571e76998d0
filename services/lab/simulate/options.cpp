// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/options.hpp"

#include <fmt/format.h>

#include "ipc/base/command_line.hpp"
#include "ipc/base/join.hpp"
#include "services/landmarks/models/landmark_models.hpp"

namespace handcast::simulate {
namespace {

constexpr char kNotes[] =
    R"(Landmarks come from the detector of the rig, a landmark model that runs on the images of the twin, or from the twin's model of one (twin):
  --set landmarks.backend={}
The age of the landmarks is simulated for every back end (twin.detector.age_ms and age_sd_ms), so that a slow machine can simulate
a fast one. "detector" in the metrics has its run time on this machine (ms_p50) and the number of hands that it missed.

The same seed gives the same figures, except for frame_us, stage_us and detector.ms_p50, which are times of this machine.)";

std::string notes() {
  std::vector<std::string_view> models;
  for (const auto& model : landmarks::landmark_models()) models.push_back(model.name);
  return fmt::format(kNotes, join(models, "|"));
}

/// Sets the setting `path`.
CommandLine::Setter setting(Options& options, const std::string& path) {
  return [&options, path](const std::string& value) {
    return options.settings.push_back(path + "=" + value), Result<void>();
  };
}

/// The rig, and what happens in it.
void add_run(CommandLine& line, Options& options) {
  line.add("--motion MOTION", setting(options, "twin.motion"),
           "Motion of the true hands: the folder of a recording, or builtin:NAME (sets "
           "twin.motion)");
  line.add("--speed K", setting(options, "twin.speed"),
           "Speed of the motion; 2 is twice as fast (sets twin.speed)");
  line.add("--seed N", setting(options, "twin.seed"),
           "Seed of all random numbers (sets twin.seed)");
  line.add("--set path=value", options.settings,
           "Changes any setting; config/REFERENCE.md lists them");
  line.add("--seconds S", options.seconds, "Scored time", {0.01, 86400});
  line.add("--warm-up S", options.warm_up_s, "Time before it that is not scored", {0, 3600});
  line.add("--quiet", options.quiet, "Prints no progress");
}

}  // namespace

Result<Options> parse(int argc, const char* const* argv) {
  CommandLine line("handcast simulate",
                   "Runs the cascade of a rig on its digital twin in virtual time and scores the "
                   "light. An example: handcast simulate config/rigs/twin.toml",
                   notes());
  Options options;
  bool joints_only = false;
  line.add("RIG.toml", options.rig_file, "The rig file");
  add_run(line, options);
  line.add("--draw-every N", options.draw_every,
           "Draws and scores every N-th projector frame; the others are only tracked", {0, 100000});
  line.add("--joints-only", joints_only,
           "Draws nothing and scores only the 21 landmarks, which takes a few per cent of the "
           "time");
  line.add("--json FILE", options.json_file, "Writes the metrics");
  line.add(
      "--frames DIR", options.frames_directory,
      "Writes pictures of the true hand with the light on it; with two projectors, that of the "
      "first, of the second, and of both");
  line.add("--picture-every N", options.picture_every, "Writes a picture of every N-th drawn frame",
           {1, 100000});
  line.add("--trace FILE.csv", options.trace_file,
           "Writes time, truth, tracker P and corrected Q per projector frame and landmark, in "
           "camera pixels");
  line.add("--record DIR", options.record_directory,
           "Writes the messages and images of the sensors as a recording for the replay back ends, "
           "and tables of them and of the true hands (docs/operating/your-own-tracker.md)");
  line.add("--poses FILE", options.poses_file,
           "Scores the poses of a .csv or .npy file in place of the tracker's");
  line.add("--landmarks FILE", options.landmarks_file,
           "Scores the landmarks of a .csv or .npy file in place of the detector's");
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  options.text = std::move(*text);
  if (joints_only) options.draw_every = 0;
  return options;
}

Result<Options> parse_export(int argc, const char* const* argv) {
  CommandLine line(
      "handcast export-twin",
      "Writes what the digital twin's sensors deliver of a motion, and the true hands, "
      "for a method that runs outside handcast: `handcast simulate --record` does the "
      "same, and --poses or --landmarks score the results.");
  Options options;
  line.add("RIG.toml", options.rig_file, "The rig file");
  line.add("DIR", options.record_directory,
           "Where the images and tables go (docs/operating/your-own-tracker.md)");
  add_run(line, options);
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  options.text = std::move(*text);
  options.draw_every = 0;
  return options;
}

}  // namespace handcast::simulate
