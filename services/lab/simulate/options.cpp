// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>

#include "services/landmarks/models/landmark_models.hpp"

namespace handcast::simulate {

namespace {

constexpr char kHelp[] =
    R"(handcast simulate RIG.toml [options]: runs the cascade of a rig on its digital twin in virtual time and scores the light.

  --motion DIR|builtin:NAME  motion of the true hands: a recording or a built-in motion (sets twin.motion)
  --speed K                  speed of the motion; 2 is twice as fast (sets twin.speed)
  --seed N                   seed of all random numbers (sets twin.seed)
  --set path=value           changes any setting; may be repeated (config/REFERENCE.md lists them)
  --seconds S                scored time (default 5)
  --warm-up S                time before it that is not scored (default 0.5)
  --draw-every N             draws and scores every N-th projector frame (default 8); the others are only tracked
  --joints-only              draws nothing and scores only the 21 landmarks, which takes a few per cent of the time
  --json FILE                writes the metrics
  --frames DIR               writes pictures of the true hand with the light on it
  --picture-every N          writes a picture of every N-th drawn frame (default 4)
  --trace FILE.csv           writes time, truth, tracker P and corrected Q per projector frame and landmark, in camera pixels
  --record DIR               writes the messages and images of the sensors as a recording for the replay back ends
  --quiet                    prints no progress
  --help, --version

Landmarks come from the detector of the rig, a landmark model that runs on the images of the twin, or from the twin's model of one (twin):
  --set landmarks.backend={}
The age of the landmarks is simulated for every back end (twin.detector.age_ms and age_sd_ms), so that a slow machine can simulate
a fast one. "detector" in the metrics has its run time on this machine (ms_p50) and the number of hands that it missed.

The same seed gives the same figures, except for frame_us, stage_us and detector.ms_p50, which are times of this machine.
)";

Result<double> number(std::string_view option, std::string_view text, double min, double max) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || !(value >= min && value <= max))
    return fail(Errc::bad_config,
                fmt::format("{}: '{}' is not a number from {} to {}", option, text, min, max));
  return value;
}

using Setter = std::function<Result<void>(std::string_view)>;

Setter text_into(std::string& target) {
  return [&target](std::string_view value) -> Result<void> {
    target = value;
    return {};
  };
}

template <class T>
Setter number_into(T& target, std::string_view option, double min, double max) {
  return [&target, option, min, max](std::string_view value) -> Result<void> {
    const auto parsed = number(option, value, min, max);
    if (!parsed) return tl::make_unexpected(parsed.error());
    if (std::is_integral_v<T> && *parsed != std::floor(*parsed))
      return fail(Errc::bad_config, fmt::format("{}: '{}' is not a whole number", option, value));
    target = static_cast<T>(*parsed);
    return {};
  };
}

Setter setting(Options& options, std::string_view path) {
  return [&options, path](std::string_view value) -> Result<void> {
    options.settings.push_back(path.empty() ? std::string(value)
                                            : fmt::format("{}={}", path, value));
    return {};
  };
}

std::map<std::string_view, Setter> setters(Options& options) {
  return {
      {"--motion", setting(options, "twin.motion")},
      {"--speed", setting(options, "twin.speed")},
      {"--seed", setting(options, "twin.seed")},
      {"--set", setting(options, "")},
      {"--seconds", number_into(options.seconds, "--seconds", 0.01, 86400)},
      {"--warm-up", number_into(options.warm_up_s, "--warm-up", 0, 3600)},
      {"--draw-every", number_into(options.draw_every, "--draw-every", 0, 100000)},
      {"--picture-every", number_into(options.picture_every, "--picture-every", 1, 100000)},
      {"--json", text_into(options.json_file)},
      {"--frames", text_into(options.frames_directory)},
      {"--trace", text_into(options.trace_file)},
      {"--record", text_into(options.record_directory)},
  };
}

}  // namespace

std::string help() {
  std::string models;
  for (const auto& model : landmarks::landmark_models())
    models += fmt::format("{}{}", models.empty() ? "" : "|", model.name);
  return fmt::format(kHelp, models);
}

Result<Options> parse_options(int argc, const char* const* argv) {
  Options options;
  const auto with_value = setters(options);
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--help" || word == "-h") {
      options.help = true;
    } else if (word == "--version") {
      options.version = true;
    } else if (word == "--joints-only") {
      options.draw_every = 0;
    } else if (word == "--quiet") {
      options.quiet = true;
    } else if (const auto setter = with_value.find(word); setter != with_value.end()) {
      if (++i >= argc)
        return fail(Errc::bad_config,
                    fmt::format("{} needs a value; see handcast simulate --help", word));
      if (auto set = setter->second(argv[i]); !set) return tl::make_unexpected(set.error());
    } else if (word.starts_with("-")) {
      return fail(Errc::bad_config,
                  fmt::format("unknown option {}; see handcast simulate --help", word));
    } else if (options.rig_file.empty()) {
      options.rig_file = word;
    } else {
      return fail(Errc::bad_config, fmt::format("there must be one rig file, but '{}' follows '{}'",
                                                word, options.rig_file));
    }
  }
  if (options.rig_file.empty() && !options.help && !options.version)
    return fail(Errc::bad_config,
                "the rig file is missing: type e.g. handcast simulate config/rigs/twin.toml; see "
                "handcast simulate --help");
  return options;
}

}  // namespace handcast::simulate
