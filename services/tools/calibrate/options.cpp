// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <tuple>

#include "calib/solve/board/board_name.hpp"
#include "config/settings/choice.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/join.hpp"

namespace handcast::calibrate {
namespace {

constexpr const char* kSummary =
    "Measures the lens of each camera, where the second one is, the projector, and the tracker's "
    "place, and writes the rig's calibration file. It starts the rig itself, says what to hold "
    "where, and can be left at any time and called again: it goes on where it was left. The old "
    "calibration is kept.\n\n"
    "Print the board first: handcast calibrate --print-board board.pdf";

constexpr double kCheck_s = 10;  ///< how long --check looks at the hand, and at the board

/// "1024x768", of a size that a calibration file may have.
Result<Size> parse_size(const std::string& flag, const std::string& text) {
  constexpr int kLeast_px = 16, kMost_px = 8192;
  const auto is_side = [](int side_px) { return side_px >= kLeast_px && side_px <= kMost_px; };
  Size size;
  const char *begin = text.data(), *end = begin + text.size();
  const auto width = std::from_chars(begin, end, size.width_px);
  const bool has_cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  if (has_cross) {
    const auto height = std::from_chars(width.ptr + 1, end, size.height_px);
    if (height.ec == std::errc() && height.ptr == end && is_side(size.width_px) &&
        is_side(size.height_px))
      return size;
  }
  return fail(Errc::bad_config,
              fmt::format("{}: '{}' is not a size like 1024x768, with {} to {} px on a side", flag,
                          text, kLeast_px, kMost_px));
}

/// Error bad_config: no rig file, although one is needed.
Result<void> check_rig_file(const Options& options) {
  if (!options.board_pdf.empty() || !options.rig_file.empty()) return {};
  return fail(Errc::bad_config, fmt::format("name the rig file: handcast calibrate RIG.toml{}",
                                            options.check             ? " --check"
                                            : options.correct         ? " --correct"
                                            : options.undo            ? " --undo"
                                            : !options.points.empty() ? " --points FOLDER"
                                                                      : ""));
}

/// An option in place of which no step is measured.
struct Task {
  const char* option;
  std::vector<std::string> takes;  ///< the options that it takes, besides the rig file
};

const std::array<Task, 5>& tasks() {
  static const std::array<Task, 5> kTasks{{
      {"--print-board", {"--board"}},
      {"--check", {"--set", "--board", "--most-s", "--yes", "--reflector"}},
      {"--points", {"--set"}},
      {"--correct", {"--set", "--most-s", "--yes"}},
      {"--undo", {"--set"}},
  }};
  return kTasks;
}

bool measures(const Options& options, Step step) {
  return options.steps.empty() || std::ranges::count(options.steps, step) > 0;
}

Result<void> check_task(const Task& task, const std::vector<std::string>& names,
                        const Options& options) {
  for (const auto& name : names) {
    if (name == task.option || std::ranges::count(task.takes, name) > 0) continue;
    const bool is_task =
        std::ranges::any_of(tasks(), [&](const Task& other) { return name == other.option; });
    return fail(Errc::bad_config,
                is_task
                    ? fmt::format("{} and {} do different things; choose one", task.option, name)
                    : fmt::format("{} does not take {}; leave it out", task.option, name));
  }
  if (options.steps.empty()) return {};
  return fail(Errc::bad_config,
              fmt::format("{} measures no single steps; leave them out", task.option));
}

/// Error bad_config: options that do not go together, of which one would have no effect. `names`:
/// the options that were given.
Result<void> check_combination(const std::vector<std::string>& names, const Options& options) {
  const auto is_given = [&](const char* name) { return std::ranges::count(names, name) > 0; };
  for (const auto& task : tasks())
    if (is_given(task.option)) return check_task(task, names, options);
  if (options.reflector_mm > 0 && !measures(options, Step::tracker))
    return fail(Errc::bad_config, "--reflector belongs to the step `tracker`; add it");
  for (const auto step : options.steps)
    if (!concerns(options, step))
      return fail(Errc::bad_config, fmt::format("--second-projector measures screen and light; {} "
                                                "is measured without it",
                                                config::word_of(step)));
  if (options.second_projector && options.reflector_mm > 0)
    return fail(Errc::bad_config, "--second-projector measures no tracker; leave --reflector out");
  if (!options.photodiode.empty() && !measures(options, Step::light))
    return fail(Errc::bad_config, "--photodiode belongs to the step `light`; add it");
  return {};
}

}  // namespace

std::filesystem::path default_folder(const Options& options) {
  return std::filesystem::path(options.rig_file)
      .replace_extension(options.second_projector ? ".projector2.calibration" : ".calibration");
}

bool concerns(const Options& options, Step step) {
  return !options.second_projector || step == Step::screen || step == Step::light;
}

Result<Options> parse(int argc, char** argv) {
  CommandLine line("handcast calibrate", kSummary);
  Options options;
  std::vector<std::string> steps;
  std::string board = calib::print_board_name(calib::Board{}), camera, camera2, projector;
  line.add("[RIG.toml]", options.rig_file, "The rig file");
  line.add("[STEP...]", steps,
           "lens, lens2, pair (of a second camera), screen, tracker, light; default: all that are "
           "left");
  line.add("--set path=value", options.settings, "A setting that overrides the file's");
  line.add("--board BOARD", board,
           "The board that you have: KIND:COLUMNSxROWS:MM; charuco, checkerboard or circles, "
           "how many squares or circles, and the side of a square in mm (measure it)");
  line.add("--print-board FILE.pdf", options.board_pdf,
           "Writes the board to this file as a PDF to be printed, and ends");
  line.add("--camera SIZE", camera,
           "Size of the camera's images, e.g. 1280x1024: only for a rig without a calibration, or "
           "for other devices than the calibrated ones");
  line.add("--camera2 SIZE", camera2,
           "Size of the second camera's images, e.g. 640x480: only if it is not calibrated yet "
           "and not that of the first camera");
  line.add("--projector SIZE", projector,
           "Size of the projector's image, e.g. 1920x1080: only for a rig without a calibration, "
           "or for other devices than the calibrated ones");
  line.add("--second-projector", options.second_projector,
           "Measures the second projector (screen and light) after the first one");
  line.add("--folder DIR", options.folder,
           "Where pictures, results and the report go; default: RIG.calibration");
  line.add("--most-s N", options.most_s,
           "Ends a step after so many seconds, even if it is not done, with what was seen; more "
           "time for a slow hand or a dark room. With --check, 10 for each part",
           {5, 3600});
  line.add("--apply", options.apply,
           "Writes the settings that were measured (projector.latency_ms, projector.gamma), and "
           "the name of a new calibration file, to RIG.measured.toml, whose values win over those "
           "of the rig file; the old file is kept");
  line.add("--photodiode DEVICE", options.photodiode,
           "An ALSA capture device with a photodiode in the projector's light: the step light "
           "measures with it when the light comes, for a camera that does not see it");
  line.add("--yes", options.yes, "Starts each step at once, without waiting for Enter");
  line.add("--restart", options.restart,
           "Forgets what was measured in this folder before it measures");
  line.add("--check", options.check,
           "Says in half a minute whether camera, tracker, projector or second camera have moved "
           "since they were calibrated, and changes nothing; the rig may be up");
  line.add("--reflector N", options.reflector_mm,
           "Measures the tracker by a retro-reflector of this diameter, mm, on the tip of an "
           "index finger, in place of the landmarks of a hand",
           {1, 50});
  line.add("--points DIR", options.points,
           "Says how good recorded points of a reflector are, and ends: a folder with "
           "2dpoints.npy (px), 3dpoints.npy (mm) and perhaps timestamps.npy (us)");
  line.add("--correct", options.correct,
           "Corrects a tracker that has moved a little, by hands that are held still, while the "
           "rig is up; asks before it writes");
  line.add("--undo", options.undo,
           "Puts back the calibration and the measured settings that the last call has changed");
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  if (!(options.text = std::move(*text)).empty()) return options;

  if (options.check && !line.has("--most-s")) options.most_s = kCheck_s;
  for (const auto& word : steps) {
    const auto step = config::choice_named<Step>(word);
    if (!step)
      return fail(Errc::bad_config, fmt::format("there is no step '{}'; there are {}", word,
                                                join(words_of(Step{}), ", ")));
    options.steps.push_back(*step);
  }
  auto parsed = calib::parse_board(board);
  if (!parsed) return fail_in("--board", parsed.error());
  options.board = *parsed;
  for (const auto& [flag, given, size] :
       {std::tuple{"--camera", &camera, &options.camera},
        std::tuple{"--camera2", &camera2, &options.camera2},
        std::tuple{"--projector", &projector, &options.projector}}) {
    if (given->empty()) continue;
    const auto read = parse_size(flag, *given);
    if (!read) return tl::make_unexpected(read.error());
    *size = *read;
  }
  if (options.folder.empty() && !options.rig_file.empty()) options.folder = default_folder(options);
  auto fits = check_combination(line.given(), options);
  if (fits) fits = check_rig_file(options);
  return fits.map([&] { return options; });
}

}  // namespace handcast::calibrate
