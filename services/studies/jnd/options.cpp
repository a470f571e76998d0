// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "ipc/base/command_line.hpp"
#include "services/studies/base/study_command.hpp"
#include "services/studies/jnd/run.hpp"

namespace handcast::study {
namespace {

constexpr char kNotes[] =
    R"(A subject does two training and two test sessions, each with light as the projector sends it (baseline) or with the
gaps at the edges of the hand filled (fill). Of two intervals, one has late light: press 1 or 2. The log is
DIR/subject-NN.csv, the times of all pictures are in DIR/subject-NN.light.csv; a session that was left with Escape, or
by a crash, goes on where it was when the command is given again. Nothing in the logs names a person.

  handcast study jnd DIR --subject 1           a subject
  handcast study jnd --analyse DIR --page OUT  the results, as in the figure of the paper
  handcast study jnd --simulate --json FILE    what the procedures do with simulated subjects)";

CommandLine::Setter size_of(StimulusSettings& settings) {
  return [&settings](const std::string& value) -> Result<void> {
    const auto* end = value.data() + value.size();
    int width = 0, height = 0;
    const auto first = std::from_chars(value.data(), end, width);
    const bool has_x = first.ptr != end && *first.ptr == 'x';
    const auto second = has_x ? std::from_chars(first.ptr + 1, end, height) : first;
    if (!has_x || second.ec != std::errc{} || second.ptr != end || width < 320 || height < 240 ||
        width > 8192 || height > 8192)
      return fail(Errc::bad_config, "must be WIDTHxHEIGHT, 320x240 to 8192x8192 px");
    settings.width_px = width;
    settings.height_px = height;
    return {};
  };
}

CommandLine::Setter procedure_of(ProcedureKind& kind) {
  return [&kind](const std::string& value) -> Result<void> {
    const auto found = std::ranges::find(kProcedureNames, value);
    kind = static_cast<ProcedureKind>(found - std::begin(kProcedureNames));
    return {};
  };
}

}  // namespace

Result<ParsedJnd> parse_jnd(int argc, char** argv) {
  ParsedJnd parsed;
  auto& options = parsed.options;
  CommandLine line("handcast study jnd",
                   "Measures which delay of light on a moving hand people notice, on a screen.",
                   kNotes);
  line.add("[DIR]", options.folder, "The folder of the study");
  line.add("--subject N", options.course.subject, "The subject, a number instead of a name",
           {1, kMostSubjects});
  line.add("--seed S", options.course.seed, "Seed of all random numbers", {0, 1e15});
  line.add("--protocol staircase|interleaved|quest", procedure_of(options.course.procedure),
           "How delays are chosen: as in the paper, by two staircases in turn, or by QUEST+");
  line.add("--size WIDTHxHEIGHT", size_of(options.stimulus), "Size of the picture, px");
  line.add("--px-per-mm K", options.stimulus.px_per_mm,
           "Pixels of a millimetre of the screen; the hand is as large as a real one", {0.5, 50});
  line.add("--monitor NAME", options.monitor, "The monitor: a part of its name, or its number");
  line.add("--window", options.in_window, "Shows a window instead of a full screen");
  line.add("--rate-hz F", options.rate_hz, "Pictures a second, if the monitor does not say",
           {10, 2000});
  line.add("--interval-s S", options.interval_s, "How long each interval is", {0.2, 30});
  line.add("--motion MOTION", options.stimulus.motion, "How the hand moves: as twin.motion");
  line.add("--speed K", options.stimulus.speed, "Speed of the motion", {0.05, 20});
  line.add("--content WHAT", options.stimulus.content, "The light: a picture, or builtin:NAME");
  line.add("--midi DEVICE", options.midi,
           "Buttons of a MIDI device answer, too: a part of its name; jack:PART, one of JACK");
  line.add("--answers-by-model", options.answers_by_model,
           "A simulated subject answers at once, to try the program");
  line.add(
      "--picture FILE.png", options.picture_file,
      "Writes a picture of the stimulus instead: no delay, and 20 ms without and with the fill");
  line.add(
      "--analyse FILE", options.analysed,
      "Analyses logs, a folder of logs, or a table with the columns subject, condition, jnd_ms");
  line.add("--simulate", options.simulates, "Lets simulated subjects take the course");
  line.add("--subjects N", options.subjects, "How many simulated subjects", {2, 100000});
  line.add("--json FILE", options.json_file, "Writes the results");
  line.add("--page DIR", options.page_folder, "Writes the results as a page, DIR/index.html");
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  parsed.text = std::move(*text);
  if (!options.analysed.empty() && options.simulates)
    return line.refusal("--analyse and --simulate exclude each other");
  return parsed;
}

}  // namespace handcast::study
