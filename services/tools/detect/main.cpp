// SPDX-License-Identifier: Apache-2.0
// handcast detect: the landmark detector on pictures.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/tools/detect/run.hpp"

namespace handcast::detect {
namespace {

const char* const kFooter =
    R"(Each picture is treated as the first image of a stream: a hand is searched at the place of --joints, otherwise at the places that the palm network finds, or, without its file, in the bright parts, as a hand is one in infrared light.
Exit 1 if no picture has a hand; a sentence says why.
Points are pixels of the picture, (0, 0) is the centre of the upper left one; they are as the network defines them, with the lens's distortion.
--out draws bones and landmarks, the square that the network was given (with a thick upper edge) and the tracker's joints as crosses.)";

std::string backend_help() {
  std::string text = "The landmark model.";
  for (const auto& model : landmarks::landmark_models())
    text += fmt::format(" {}: {}", model.name, model.sentence);
  return text;
}

int detect(const Options& options) {
  const auto report = run(options);
  if (!report) {
    fmt::print(stderr, "handcast detect: {}\n", printable(report.error().what));
    return exit_code_of(report.error());
  }
  fmt::print("{}", report->text);
  return report->has_hand ? kExitDone : kExitBadResult;
}

}  // namespace
}  // namespace handcast::detect

static int run_verb(int argc, char** argv) {
  using namespace handcast;
  detect::Options options;
  CommandLine line("handcast detect", "Finds the 21 landmarks of the hands in pictures.",
                   detect::kFooter);
  line.add("IMAGE...", options.images, "PNG or JPEG pictures");
  line.add("--joints FILE.npy", options.joints,
           "A tracker's joints in the picture, one .npy file per picture: (21,2) in pixels, or "
           "(42,2) in -1..1");
  line.add(
      "--side left|right",
      [&](const std::string& side) -> Result<void> {
        options.joints_side = side == "left" ? msg::Side::left : msg::Side::right;
        return {};
      },
      "The side of the hand in --joints (default: left)");
  line.add("--model DIR", options.models,
           "The folder of MediaPipe's files; scripts/get-models fetches them");
  line.add("--backend NAME", options.backend,
           detect::backend_help() + " (default: mediapipe, or handcast without its files)");
  line.add("--hands N", options.hands, "The largest number of hands", {1, 2});
  line.add("-o, --out DIR", options.output, "A folder for drawings of the results");
  line.add("--repeat N", options.repeat,
           "Repeats each detection and prints the median of the times", {1, 100000});
  line.add("--json", options.json, "Prints JSON");
  line.add("--quiet", options.quiet, "Prints no progress");
  if (const auto code = line.answered(argc, argv)) return *code;
  return detect::detect(options);
}

int main(int argc, char** argv) {
  return handcast::run_program("handcast detect", argc, argv, run_verb);
}
